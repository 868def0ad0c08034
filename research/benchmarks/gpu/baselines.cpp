#include "research/benchmarks/gpu/baselines.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/quadrature/quadrature_solver.h"
#include "research/benchmarks/gpu/contenders.h"

namespace toile::research::gpu {

namespace {

/// Number of timed steps after a sampled one.
constexpr int kTimed = 5;

/// Settings of our method between samples, and for the approach to the minimiser of a sampled step. Newton's
/// method on the CPU then has little left to do, but enough to measure the remaining error.
constexpr double kBetweenTolerance = 1e-7; ///< [m]
constexpr int kBetween = 500, kTowards = 1000;

/// Number of XPBD substeps that approximates the limit. Errors are inversely proportional to it.
constexpr int kLimit = 4096;

/// Relative energy gap that counts as an explosion [-]; 1 is the error of no iteration at all.
constexpr double kExploded = 1e3;

double now_ms()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

std::vector<Vec3> copy_of(View<const Vec3> field) { return {field.begin(), field.end()}; }

/// Inputs of every step of a problem.
struct Stepping {
    const solvers::Problem& problem;
    std::vector<Vec3> acceleration = problem.acceleration();

    /// @return iterations
    int step(PointMasses& masses, int parts = 1) const
    {
        int iterations = 0;
        for (int k = 0; k < parts; ++k)
            iterations += masses
                              .step(problem.dt / parts, acceleration, problem.fixed, problem.start.positions,
                                    nullptr, nullptr)
                              .iterations;
        return iterations;
    }

    /// Positions after a sampled step.
    std::vector<Vec3> after(const Sample& sample, PointMasses& masses) const
    {
        masses.set_positions(sample.step.x);
        masses.set_velocities(sample.step.v);
        step(masses);
        return {masses.positions().begin(), masses.positions().end()};
    }
};

std::unique_ptr<System> make_system(const solvers::Problem& problem)
{
    auto system = problem.make_system(
        std::make_unique<QuadratureSolver>(problem.points(), QuadratureSolver::Settings{}, problem.tables));
    system->prepare(problem.dt, problem.fixed);
    return system;
}

std::vector<Sample> sample_steps(const CudaSpace& space, const Stepping& stepping, const System& system,
                                 const BaselinesCase& what)
{
    const solvers::Problem& problem = stepping.problem;
    const std::unique_ptr<PointMasses> body = make_ours(space, problem, kBetweenTolerance, kBetween);
    const std::unique_ptr<PointMasses> towards = make_ours(space, problem, 0.0, kTowards);
    const std::unique_ptr<PointMasses> small_steps = make_xpbd(space, problem, kLimit);
    std::vector<Sample> samples;
    std::vector<Vec3> v_before = copy_of(body->velocities());
    for (int k = 1; k <= what.stride * what.steps; ++k) {
        Sample sample{{copy_of(body->positions()), copy_of(body->velocities()), {}, {}}, v_before, {}};
        v_before = sample.step.v;
        if (k % what.stride == 0) {
            sample.limit = stepping.after(sample, *small_steps);
            sample.step.minimiser = stepping.after(sample, *towards);
            solvers::converge_near(problem, system, sample.step);
            samples.push_back(std::move(sample));
        }
        stepping.step(*body);
    }
    return samples;
}

double mean_square_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double sum = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        sum += (a[v] - b[v]).squaredNorm();
    return sum / double(a.size());
}

/// Measures one method on the samples of a problem.
class Measurement {
public:
    Measurement(const CudaSpace& space, const Stepping& stepping, const System& system,
                const std::vector<Sample>& samples)
        : space_(space), stepping_(stepping), system_(system), samples_(samples)
    {
    }

    void of(const DeviceMethod& method, std::vector<solvers::Result>& results) const
    {
        solvers::Result result;
        result.mesh = stepping_.problem.mesh;
        result.vertices = stepping_.problem.vertex_count();
        result.stiffness = stepping_.problem.stiffness;
        result.dt = stepping_.problem.dt;
        result.method = method.name;

        const size_t before = space_.memory().device_bytes;
        const double begin = now_ms();
        const Contender contender = method.make(space_, stepping_.problem);
        stepping_.step(*contender.masses, method.parts);
        result.setup_ms = now_ms() - begin;
        result.peak_mb = 1e-6 * double(space_.memory().device_bytes - before);

        std::vector<double> times;
        double from_minimiser = 0.0, from_limit = 0.0; // [m^2]
        for (const Sample& sample : samples_) {
            contender.begin(sample);
            result.iterations += stepping_.step(*contender.masses, method.parts) / double(samples_.size());
            const std::vector<Vec3> x = copy_of(contender.masses->positions());
            from_minimiser += mean_square_distance(x, sample.step.minimiser) / double(samples_.size());
            from_limit += mean_square_distance(x, sample.limit) / double(samples_.size());
            add_gap(sample.step, x, result);
            for (int k = 0; k < kTimed; ++k) {
                const double start = now_ms();
                stepping_.step(*contender.masses, method.parts);
                times.push_back(now_ms() - start);
            }
        }
        std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
        result.step_ms = times[times.size() / 2];
        result.setup_ms = std::max(result.setup_ms - result.step_ms, 0.0);
        if (!std::isfinite(result.energy_gap) || result.energy_gap > kExploded)
            return;

        result.rms_over_edge = std::sqrt(from_minimiser) / stepping_.problem.mean_edge;
        if (method.parts == 1)
            results.push_back(result);
        result.rms_over_edge = std::sqrt(from_limit) / stepping_.problem.mean_edge;
        result.energy_gap = 0.0;
        result.is_reference_converged = true;
        result.mesh += " in small steps";
        if (method.parts > 1 || method.name.starts_with("xpbd"))
            results.push_back(result);
    }

private:
    void add_gap(const solvers::SampledStep& step, const std::vector<Vec3>& x, solvers::Result& result) const
    {
        result.is_reference_converged &= step.is_converged;
        result.energy_gap += (objective(stepping_.problem, system_, step, x) - step.energy) /
                             (step.start_energy - step.energy) / double(samples_.size());
    }

    const CudaSpace& space_;
    const Stepping& stepping_;
    const System& system_;
    const std::vector<Sample>& samples_;
};

} // namespace

std::vector<solvers::Result> measure_baselines(const CudaSpace& space, const BaselinesCase& what)
{
    const auto problem = solvers::Problem::sheet(what.vertices, what.stiffness, what.dt);
    const Stepping stepping{problem};
    const std::unique_ptr<System> system = make_system(problem);
    const std::vector<Sample> samples = sample_steps(space, stepping, *system, what);
    const Measurement measurement(space, stepping, *system, samples);
    std::vector<solvers::Result> results;
    for (const DeviceMethod& method : device_methods(problem))
        measurement.of(method, results);
    return results;
}

} // namespace toile::research::gpu
