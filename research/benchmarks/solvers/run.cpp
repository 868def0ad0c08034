#include "research/benchmarks/solvers/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "core/compute/parallel.h"
#include "research/benchmarks/memory_meter.h"
#include "research/benchmarks/text_table.h"
#include "research/linear/jacobi_pcg.h"

namespace toile::research::solvers {

namespace {

double now_ms()
{
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::chrono::duration<double, std::milli>(now).count();
}

double mean_square_distance(View<const Vec3> a, const std::vector<Vec3>& b)
{
    double sum = 0.0;
    for (int v = 0; v < a.size(); ++v)
        sum += (a[v] - b[v]).squaredNorm();
    return sum / a.size();
}

std::vector<Row> rows_of(const std::vector<Result>& results)
{
    std::vector<Row> rows;
    rows.reserve(results.size());
    for (const Result& r : results)
        rows.push_back({r.mesh, std::to_string(r.vertices), format("%g", r.stiffness), format("%.5g", r.dt),
                        r.method, std::to_string(r.threads), format("%.1f", r.setup_ms),
                        format("%.3f", r.step_ms), format("%.1f", r.iterations),
                        format("%.3e", r.rms_over_edge), format("%.3e", r.energy_gap),
                        format("%.1f", r.peak_mb), format("%.1f", r.gradients), format("%.1f", r.solves),
                        r.is_reference_converged ? "converged" : "not converged"});
    return rows;
}

const Row kHeader{"mesh",       "vertices", "stiffness",   "dt",         "method",
                  "threads",    "setup_ms", "ms_per_step", "iterations", "rms_over_edge",
                  "energy_gap", "peak_mb",  "gradients",   "solves",     "reference"};

/// Time [ms] after which no further repeat of a method begins: slow steps are measured well enough.
constexpr double kMaxTimed = 2500.0;

} // namespace

Result run(const Problem& problem, const std::vector<SampledStep>& steps, const Method& method, int repeats,
           KeptTables* kept)
{
    Result result;
    result.mesh = problem.mesh;
    result.vertices = problem.vertex_count();
    result.stiffness = problem.stiffness;
    result.dt = problem.dt;
    result.method = method.name;
    result.threads = thread_count(kCpu);

    MemoryMeter memory;
    const double begin = now_ms();
    Stages preparing;
    std::unique_ptr<Stepper> stepper;
    {
        const Stages::Activate activate(preparing);
        stepper = method.make(problem);
        stepper->step(steps.front());
    }
    const double first_ms = now_ms() - begin;
    result.peak_mb = memory.peak_mb();

    result.step_ms = std::numeric_limits<double>::infinity();
    const double timed = now_ms();
    for (int k = 0; k < repeats && (k == 0 || now_ms() - timed < kMaxTimed); ++k) {
        double total = 0.0;
        for (const SampledStep& step : steps) {
            const double start = now_ms();
            stepper->step(step);
            total += now_ms() - start;
        }
        result.step_ms = std::min(result.step_ms, total / double(steps.size()));
    }
    result.setup_ms = std::max(first_ms - result.step_ms, 0.0);
    if (kept && method.uses_tables && kept->owner) {
        result.setup_ms += kept->build_ms;
        result.peak_mb = std::max(result.peak_mb, kept->peak_mb);
    }

    // System for evaluation: its solver is never used, and a factor would be shared with later methods.
    const std::unique_ptr<System> system = problem.make_system(std::make_unique<JacobiPcg>());
    system->prepare(problem.dt, problem.fixed);
    double squares = 0.0;
    for (const SampledStep& step : steps) {
        Stages stages;
        {
            const Stages::Activate activate(stages);
            result.iterations += stepper->step(step) / double(steps.size());
        }
        result.gradients += double(stages.calls(problem.solid ? "volume/elastic" : "garment/membrane")) /
                            double(steps.size());
        result.solves += double(stages.calls("linear/solve")) / double(steps.size());
        const std::vector<Vec3> x(stepper->positions().begin(), stepper->positions().end());
        result.is_reference_converged &= step.is_converged;
        squares += mean_square_distance(x, step.minimiser) / double(steps.size());
        result.energy_gap += (objective(problem, *system, step, x) - step.energy) /
                             (step.start_energy - step.energy) / double(steps.size());
    }
    if (kept && method.uses_tables && !kept->owner)
        *kept = {std::move(stepper), 1000.0 * preparing.seconds("quadrature/build"), result.peak_mb};
    result.rms_over_edge = std::sqrt(squares) / problem.mean_edge;
    return result;
}

std::string csv_table(const std::vector<Result>& results) { return csv(kHeader, rows_of(results)); }
std::string markdown_table(const std::vector<Result>& results) { return markdown(kHeader, rows_of(results)); }

} // namespace toile::research::solvers
