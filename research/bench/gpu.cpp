#include <functional>
#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/gpu/table.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"gpu_apply.csv",     "gpu_step.csv",   "gpu_near_pairs.csv",
                                       "gpu_colliders.csv", "gpu_tables.csv", "gpu_scenes.csv",
                                       "gpu_baselines.csv", "gpu_rules.csv",  "gpu_tables.md"};

/// Stiffness and time step of the paper's Cloth scene.
constexpr double kStiffness = 1e4; ///< [N/m]
constexpr double kTimeStep = 1.0 / 120.0;

/// Sizes of the sheet [vertices]; tables of the largest take minutes to build on a few cores.
const std::vector<int> kSizes{10'000, 50'000};
const std::vector<int> kQuickSizes{2'000};

/// Sizes whose tables are built on the device [vertices], and the maximum size built on the CPU too: a larger
/// one takes it a minute.
const std::vector<int> kBuildSizes{10'000, 50'000, 240'000};
constexpr int kMaxCompared = 60'000;

/// Step cases: the paper's Cloth scene, the same number of vertices in one sheet, and its Runway scene.
const std::vector<gpu::StepCase> kSteps{{5, 10'000, kStiffness, kTimeStep},
                                        {1, 50'000, kStiffness, kTimeStep},
                                        {1, 240'000, kStiffness, kTimeStep}};
const std::vector<gpu::StepCase> kQuickSteps{{2, 1'000, kStiffness, kTimeStep}};

/// Sizes of the folded sheet for near pairs, and of the dress on a body for collider pairs [vertices].
const std::vector<int> kFoldedSizes{50'000, 240'000};

/// Our versions of the paper's scenes, also with its stopping criterion; Runway also with a million vertices;
/// and a dance.
const std::vector<gpu::SceneCase> kScenes{
    {"cloth", "scenes/benchmarks/cloth.json", 60, 20},
    {"cloth_by_move", "scenes/benchmarks/cloth.json", 60, 20, 0, StepStop::Move},
    {"runway_60", "scenes/benchmarks/runway.json", 60, 0, 1},
    {"runway_60_by_move", "scenes/benchmarks/runway.json", 60, 0, 1, StepStop::Move},
    {"runway_120", "scenes/benchmarks/runway.json", 60, 0, 2},
    {"runway_240", "scenes/benchmarks/runway.json", 20, 0, 4},
    {"runway_1m", "scenes/benchmarks/runway_1m.json", 5},
    {.name = "dance", .file = "scenes/data/dance.json", .frames = 90, .cpu_frames = 5, .needs_data = true},
};
const std::vector<gpu::SceneCase> kQuickScenes{{"tablecloth", "scenes/demo/tablecloth.json", 8, 8}};

/// Comparison with baselines from equal states: two steps of a swinging sheet. The paper's rule is built for
/// the smallest sheet only.
const std::vector<gpu::BaselinesCase> kBaselines{{2'500, 1e3, kTimeStep, 2, 16},
                                                 {10'000, 1e3, kTimeStep, 2, 16},
                                                 {10'000, 1e4, kTimeStep, 2, 16},
                                                 {50'000, 1e3, kTimeStep, 2, 16},
                                                 {50'000, 1e4, kTimeStep, 2, 16}};
const std::vector<gpu::BaselinesCase> kQuickBaselines{{900, 1e3, kTimeStep, 2, 4}};

/// Sizes of copies that exceed all caches, and of copies that fit the L2 cache twice [MB].
constexpr int kLargeCopy = 1000, kSmallCopy = 8;

/// A named measurement.
struct Case {
    std::string name;
    std::function<void(const CudaSpace&, gpu::Report&)> measure;
};

std::vector<Case> cases_of(const BenchOptions& options)
{
    std::vector<Case> cases;
    for (const int vertices : options.quick ? kQuickSizes : kSizes)
        cases.push_back(
            {"solve " + std::to_string(vertices), [=](const CudaSpace& space, gpu::Report& report) {
                 report.applies.push_back(gpu::measure_apply(space, vertices, kStiffness, kTimeStep));
             }});
    for (const int vertices : options.quick ? kQuickSizes : kBuildSizes)
        cases.push_back(
            {"tables " + std::to_string(vertices), [=](const CudaSpace& space, gpu::Report& report) {
                 report.builds.push_back(
                     gpu::measure_build(space, vertices, kStiffness, kTimeStep, vertices <= kMaxCompared));
             }});
    for (const gpu::StepCase& step : options.quick ? kQuickSteps : kSteps)
        cases.push_back({"step " + std::to_string(step.cloths) + "x" + std::to_string(step.vertices),
                         [what = step](const CudaSpace& space, gpu::Report& report) {
                             report.steps.push_back(gpu::measure_step(space, what));
                         }});
    for (const int vertices : options.quick ? kQuickSizes : kFoldedSizes)
        cases.push_back(
            {"near_pairs " + std::to_string(vertices), [=](const CudaSpace& space, gpu::Report& report) {
                 gpu::measure_near_pairs(space, vertices, report.searches);
             }});
    for (const int vertices : options.quick ? kQuickSizes : kFoldedSizes)
        cases.push_back(
            {"colliders " + std::to_string(vertices), [=](const CudaSpace& space, gpu::Report& report) {
                 gpu::measure_colliders(space, vertices, report.colliders);
             }});
    for (const gpu::SceneCase& scene : options.quick ? kQuickScenes : kScenes)
        cases.push_back({"scene " + scene.name, [what = scene](const CudaSpace& space, gpu::Report& report) {
                             for (gpu::SceneRun& run : gpu::measure_scene(space, what))
                                 report.scenes.push_back(std::move(run));
                         }});
    for (const gpu::BaselinesCase& baselines : options.quick ? kQuickBaselines : kBaselines)
        cases.push_back({"baselines " + std::to_string(baselines.vertices) + "x" +
                             std::to_string(int(baselines.stiffness)),
                         [what = baselines](const CudaSpace& space, gpu::Report& report) {
                             for (solvers::Result& result : gpu::measure_baselines(space, what))
                                 report.baselines.push_back(std::move(result));
                         }});
    const gpu::BaselinesCase small = (options.quick ? kQuickBaselines : kBaselines).front();
    cases.push_back({"global solvers of the baselines", [=](const CudaSpace& space, gpu::Report& report) {
                         gpu::measure_rules(space, small.vertices, small.stiffness, small.dt, report.rules);
                     }});
    std::erase_if(cases, [&](const Case& c) { return c.name.find(options.only) == std::string::npos; });
    if (cases.empty())
        throw InvalidInput("gpu: --only \"" + options.only + "\" leaves no case");
    return cases;
}

/// Tables of a report, with their file names.
/// @param is_whole  false: only tables that have rows
std::vector<TableFile> tables_of(const gpu::Report& report, bool is_whole)
{
    std::vector<TableFile> tables;
    const auto add = [&](const std::string& name, bool has_rows, const std::string& text) {
        if (is_whole || has_rows)
            tables.push_back({name, text});
    };
    add(kTables[0], !report.applies.empty(), gpu::csv_of_applies(report));
    add(kTables[1], !report.steps.empty(), gpu::csv_of_steps(report));
    add(kTables[2], !report.searches.empty(), gpu::csv_of(report.searches));
    add(kTables[3], !report.colliders.empty(), gpu::csv_of(report.colliders));
    add(kTables[4], !report.builds.empty(), gpu::csv_of(report.builds));
    add(kTables[5], !report.scenes.empty(), gpu::csv_of(report.scenes));
    add(kTables[6], !report.baselines.empty(), solvers::csv_table(report.baselines));
    add(kTables[7], !report.rules.empty(), gpu::csv_of(report.rules));
    add(kTables[8], false, gpu::markdown_tables(report));
    return tables;
}

} // namespace

int bench_gpu(const BenchOptions& options)
{
    if (!options.output.empty())
        require_writable(options.output, kTables);
    const std::vector<Case> cases = cases_of(options);
    if (const std::string reason = why_no_cuda_device(); !reason.empty())
        throw DeviceError("gpu: no CUDA device: " + reason);
    const CudaSpace space(0);
    const app::InterruptGuard interrupt;
    gpu::Report report;
    report.device = space.device();
    report.copy_gbs = gpu::copy_bandwidth(space, kLargeCopy);
    report.small_copy_gbs = gpu::copy_bandwidth(space, kSmallCopy);
    app::Progress progress("case", int(cases.size()), options.quiet);
    size_t done = 0;
    while (done < cases.size() && !interrupt.requested()) {
        cases[done].measure(space, report);
        progress.update(int(done) + 1, cases[done].name);
        ++done;
    }

    std::cout << gpu::markdown_tables(report);
    if (done < cases.size()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, tables_of(report, options.only.empty()));
    return app::kExitOk;
}

} // namespace toile::research
