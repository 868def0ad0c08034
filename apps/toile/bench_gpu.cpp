#include <iostream>

#include "apps/toile/bench.h"
#include "apps/toile/bench_tables.h"
#include "apps/toile/command_line.h"
#include "apps/toile/interrupt.h"
#include "apps/toile/progress.h"
#include "benchmarks/gpu/build_tables.h"
#include "benchmarks/gpu/table.h"
#include "core/backend/error.h"

namespace toile {

namespace {

const std::vector<std::string> kTables{"gpu_apply.csv", "gpu_step.csv", "gpu.md", "gpu_tables.csv"};

/// Sizes of the sheet [vertices]; tables of the largest take minutes to build on a few cores.
const std::vector<int> kSizes{10'000, 50'000};
const std::vector<int> kQuickSizes{2'000};

/// Sizes whose tables are built on the device, and up to which the CPU builds them too: more takes it a
/// minute [vertices].
const std::vector<int> kBuildSizes{10'000, 50'000, 240'000};
constexpr int kMostCompared = 60'000;

/// Steps: as the paper's Cloth scene, the same number of vertices in one sheet, and as its Runway scene.
const std::vector<gpu::StepCase> kSteps{{5, 10'000}, {1, 50'000}, {1, 240'000}};
const std::vector<gpu::StepCase> kQuickSteps{{2, 1'000}};

/// As the paper's Cloth scene.
constexpr double kStiffness = 1e4; ///< [N/m]
constexpr double kTimeStep = 1.0 / 120.0;

/// Copies that fit no cache, and such that fit the L2 cache twice [MB].
constexpr int kLargeCopy = 1000, kSmallCopy = 8;

} // namespace

int bench_gpu(const BenchOptions& options)
{
    if (!options.output.empty())
        require_place(options.output, kTables);
    if (const std::string reason = why_no_cuda_device(); !reason.empty())
        throw DeviceError("bench gpu: no CUDA device: " + reason);
    const CudaSpace space(0);
    const InterruptGuard interrupt;
    gpu::Report report{space.device(),
                       gpu::copy_bandwidth(space, kLargeCopy),
                       gpu::copy_bandwidth(space, kSmallCopy),
                       {},
                       {}};
    const std::vector<int>& sizes = options.quick ? kQuickSizes : kSizes;
    const std::vector<gpu::StepCase>& steps = options.quick ? kQuickSteps : kSteps;
    Progress progress("case", int(sizes.size() + steps.size()), options.quiet);
    int done = 0;
    for (size_t k = 0; k < sizes.size() && !interrupt.requested(); ++k) {
        report.applies.push_back(gpu::measure_apply(space, sizes[k], kStiffness, kTimeStep));
        progress.update(++done, "solves of " + std::to_string(sizes[k]) + " vertices");
    }
    for (size_t k = 0; k < steps.size() && !interrupt.requested(); ++k) {
        gpu::StepCase what = steps[k];
        what.stiffness = kStiffness;
        what.dt = kTimeStep;
        report.steps.push_back(gpu::measure_step(space, what));
        progress.update(++done, "steps of " + std::to_string(what.cloths) + " x " +
                                    std::to_string(what.vertices) + " vertices");
    }

    std::vector<gpu::TableBuild> builds;
    for (const int vertices : options.quick ? kQuickSizes : kBuildSizes)
        if (!interrupt.requested())
            builds.push_back(
                gpu::measure_build(space, vertices, kStiffness, kTimeStep, vertices <= kMostCompared));

    const std::string tables = gpu::markdown_tables(report) + "\n" + gpu::markdown_of(builds);
    std::cout << tables;
    if (interrupt.requested()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return kExitFailure;
    }
    write_tables(options.output, {{kTables[0], gpu::csv_of_applies(report)},
                                  {kTables[1], gpu::csv_of_steps(report)},
                                  {kTables[2], tables},
                                  {kTables[3], gpu::csv_of(builds)}});
    return kExitOk;
}

} // namespace toile
