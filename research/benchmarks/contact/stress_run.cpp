#include "research/benchmarks/contact/stress_run.h"

#include <algorithm>
#include <cmath>

#include "collision/check/find_crossings.h"
#include "research/benchmarks/contact/parts.h"
#include "research/benchmarks/stress/energy_meter.h"
#include "scenes/world/world.h"

namespace toile::research::contact_stress {

namespace {

/// All sheets as one list of triangles.
class Soup {
public:
    explicit Soup(View<const scenes::ClothState> cloths) : cloths_(cloths)
    {
        int first = 0;
        for (const scenes::ClothState& cloth : cloths) {
            for (const Triangle& t : cloth.triangles)
                triangles_.emplace_back(first + t[0], first + t[1], first + t[2]);
            first += int(cloth.positions.size());
        }
    }

    std::vector<Vec3> positions() const
    {
        std::vector<Vec3> x;
        for (const scenes::ClothState& cloth : cloths_)
            x.insert(x.end(), cloth.positions.begin(), cloth.positions.end());
        return x;
    }

    int crossings(const std::vector<Vec3>& x) const
    {
        return int(collision::find_crossings(triangles_, x).size());
    }

private:
    View<const scenes::ClothState> cloths_;
    std::vector<Triangle> triangles_;
};

/// Total energy of all sheets.
class Energies {
public:
    Energies(View<const scenes::ClothState> cloths, const Vec3& gravity)
    {
        for (const scenes::ClothState& cloth : cloths)
            meters_.emplace_back(cloth, gravity);
    }

    /// @param x_t0, x_t1  [vertices] one step of dt [s] apart
    double measure(double dt, const std::vector<Vec3>& x_t0, const std::vector<Vec3>& x_t1,
                   View<const scenes::ClothState> cloths)
    {
        std::vector<Vec3> v(x_t1.size());
        for (size_t i = 0; i < v.size(); ++i)
            v[i] = (x_t1[i] - x_t0[i]) / dt;
        double energy = 0.0;
        int first = 0;
        for (int c = 0; c < cloths.size(); ++c) {
            const int count = int(cloths[c].positions.size());
            energy += meters_[c].measure(View<const Vec3>(x_t1).subview(first, count),
                                         View<const Vec3>(v).subview(first, count));
            first += count;
        }
        return energy;
    }

private:
    std::vector<stress::EnergyMeter> meters_;
};

/// Records the results of a run step by step.
class Observer {
public:
    Observer(const StressCase& trial, const scenes::World& world, const Vec3& gravity, StressRun& run)
        : trial_(trial), cloths_(world.cloths()), soup_(cloths_), energies_(cloths_, gravity), run_(run),
          x_(soup_.positions())
    {
        run_.vertices = int(x_.size());
        run_.crossings = soup_.crossings(x_);
    }

    void observe(const StepReport& report)
    {
        std::vector<Vec3> x = soup_.positions();
        run_.is_finite = report.status != StepReport::Status::NonFinite &&
                         std::all_of(x.begin(), x.end(), [](const Vec3& p) { return p.allFinite(); });
        if (!run_.is_finite)
            return;
        const int crossings = soup_.crossings(x);
        if (crossings > 0 && run_.crossings == 0)
            run_.first_crossing = run_.steps;
        run_.crossings = std::max(run_.crossings, crossings);
        run_.max_strain = std::max(run_.max_strain, report.max_strain);

        const double energy = energies_.measure(trial_.dt, x_, x, cloths_);
        if (run_.steps == 1)
            thrown_energy_ = energy;
        run_.end_energy = energy / thrown_energy_;
        if (run_.steps > 1)
            run_.energy_ratio = std::max(run_.energy_ratio, run_.end_energy);
        run_.is_finite = std::isfinite(energy);
        x_ = std::move(x);
    }

private:
    const StressCase& trial_;
    View<const scenes::ClothState> cloths_;
    Soup soup_;
    Energies energies_;
    StressRun& run_;
    std::vector<Vec3> x_;
    double thrown_energy_ = 0.0; ///< [J] after the first step
};

bool holds(const StressRun& run)
{
    return run.is_finite && run.crossings == 0 && run.energy_ratio <= 1.0 + kEnergyGain;
}

} // namespace

StressRun run(const StressCase& trial, unsigned seed, const scenes::Scene& scene,
              const std::function<bool(int)>& after_step)
{
    StressRun result;
    result.seed = seed;
    scenes::World world(scene);
    Observer observer(trial, world, scene.gravity, result);
    PartSeconds start{};
    while (result.steps < trial.steps() && result.is_finite) {
        const StepReport report = world.advance_frame();
        ++result.steps;
        observer.observe(report);
        if (result.steps == 1) {
            start = seconds_by_part(world.stages());
        } else {
            result.contacts += report.contacts;
            result.iterations += report.iterations;
        }
        if (!after_step(result.steps))
            break;
    }
    const int steps = std::max(1, result.steps - 1);
    result.contacts /= steps;
    result.iterations /= steps;
    result.ms_per_step = 1e3 / steps * step_seconds(difference(seconds_by_part(world.stages()), start));
    result.holds = holds(result);
    return result;
}

StressResult summarise(const StressCase& trial, std::vector<StressRun> runs)
{
    StressRun worst;
    worst.holds = true;
    const double weight = 1.0 / double(runs.size());
    for (const StressRun& run : runs) {
        worst.vertices = run.vertices;
        worst.steps = std::max(worst.steps, run.steps);
        worst.contacts += weight * run.contacts;
        worst.iterations += weight * run.iterations;
        worst.ms_per_step += weight * run.ms_per_step;
        worst.crossings = std::max(worst.crossings, run.crossings);
        worst.max_strain = std::max(worst.max_strain, run.max_strain);
        worst.energy_ratio = std::max(worst.energy_ratio, run.energy_ratio);
        worst.end_energy =
            &run == &runs.front() ? run.end_energy : std::max(worst.end_energy, run.end_energy);
        worst.is_finite = worst.is_finite && run.is_finite;
        if (worst.holds && !run.holds) {
            worst.seed = run.seed;
            worst.first_crossing = run.first_crossing;
        }
        worst.holds = worst.holds && run.holds;
    }
    return {trial, std::move(runs), worst};
}

} // namespace toile::research::contact_stress
