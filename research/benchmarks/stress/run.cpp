#include "research/benchmarks/stress/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/linear/field.h"
#include "research/benchmarks/stress/energy_meter.h"
#include "research/benchmarks/stress/random_positions.h"

namespace toile::research::stress {

namespace {

using Clock = std::chrono::steady_clock;

scenes::World make_world(const Case& trial)
{
    scenes::World world(trial.scene);
    if (trial.start)
        world.place(0, random_positions(*trial.start, world.cloths()[0].positions.size()));
    world.settle();
    return world;
}

/// Records the results of a case step by step.
class Observer {
public:
    Observer(const Case& trial, const Limits& limits, const scenes::ClothState& cloth)
        : trial_(trial), limits_(limits), meter_(cloth, trial.scene.gravity), start_(cloth.positions),
          x_(cloth.positions), v_(cloth.positions.size(), Vec3::Zero()), start_energy_(meter_.measure(x_, v_))
    {
    }

    void observe(int step, const std::vector<Vec3>& positions)
    {
        double max_drift = 0.0;
        for (size_t i = 0; i < positions.size(); ++i) {
            v_[i] = (positions[i] - x_[i]) / trial_.dt();
            max_drift = std::max(max_drift, (positions[i] - start_[i]).norm());
        }
        x_ = positions;
        drift_ = std::max(drift_, max_drift);
        energy_ = meter_.measure(x_, v_);
        is_finite_ = is_finite_ && std::isfinite(energy_);
        peak_energy_ = std::max(peak_energy_, energy_);
        if ((trial_.steps() - step) * trial_.dt() < limits_.rest_window)
            final_speed_ = std::max(final_speed_, max_norm(v_));
    }

    void conclude(Result& result) const
    {
        result.final_speed = final_speed_;
        result.drift = trial_.starts_at_rest ? drift_ : 0.0;
        result.energy_ratio = peak_energy_ / (start_energy_ + meter_.mass() * trial_.granted_energy);
        result.end_energy = energy_ / start_energy_;
        result.is_finite = result.is_finite && is_finite_;
        result.is_at_rest = result.is_finite && final_speed_ < limits_.rest_speed;
        result.holds = result.is_at_rest && result.energy_ratio <= 1.0 + limits_.energy_gain &&
                       result.drift <= limits_.drift;
    }

private:
    const Case& trial_;
    const Limits& limits_;
    EnergyMeter meter_;
    std::vector<Vec3> start_, x_, v_;
    double start_energy_;
    double energy_ = 0.0;
    double peak_energy_ = 0.0;
    bool is_finite_ = true; ///< every energy so far
    double drift_ = 0.0;
    double final_speed_ = 0.0;
};

bool is_finite(const std::vector<Vec3>& positions)
{
    return std::all_of(positions.begin(), positions.end(), [](const Vec3& p) { return p.allFinite(); });
}

} // namespace

Result run(const Case& trial, const Limits& limits, const std::function<bool(int)>& after_step)
{
    Result result;
    result.name = trial.name;
    scenes::World world = make_world(trial);
    const scenes::ClothState& cloth = world.cloths()[0];
    Observer observer(trial, limits, cloth);
    long iterations = 0;
    double seconds = 0.0;
    while (result.steps < trial.steps() && result.is_finite) {
        const Clock::time_point start = Clock::now();
        const StepReport report = world.advance_frame();
        seconds += std::chrono::duration<double>(Clock::now() - start).count();
        ++result.steps;
        iterations += report.iterations;
        result.max_strain = std::max(result.max_strain, report.max_strain);
        result.is_finite = report.status != StepReport::Status::NonFinite && is_finite(cloth.positions);
        if (result.is_finite)
            observer.observe(result.steps, cloth.positions);
        if (!after_step(result.steps))
            break;
    }
    result.iterations_per_step = double(iterations) / result.steps;
    result.ms_per_step = 1e3 * seconds / result.steps;
    observer.conclude(result);
    return result;
}

} // namespace toile::research::stress
