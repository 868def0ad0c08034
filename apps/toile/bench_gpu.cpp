#include <functional>
#include <iostream>

#include "apps/toile/bench.h"
#include "apps/toile/bench_tables.h"
#include "apps/toile/command_line.h"
#include "apps/toile/interrupt.h"
#include "apps/toile/progress.h"
#include "benchmarks/gpu/table.h"
#include "core/backend/error.h"

namespace toile {

namespace {

const std::vector<std::string> kTables{"gpu_apply.csv",     "gpu_step.csv",   "gpu_near_pairs.csv",
                                       "gpu_colliders.csv", "gpu_tables.csv", "gpu_scenes.csv",
                                       "gpu_rivals.csv",    "gpu_rules.csv",  "gpu_tables.md"};

/// As the paper's Cloth scene.
constexpr double kStiffness = 1e4; ///< [N/m]
constexpr double kTimeStep = 1.0 / 120.0;

/// Sizes of the sheet [vertices]; tables of the largest take minutes to build on a few cores.
const std::vector<int> kSizes{10'000, 50'000};
const std::vector<int> kQuickSizes{2'000};

/// Sizes whose tables are built on the device, and up to which the CPU builds them too: more takes it a
/// minute [vertices].
const std::vector<int> kBuildSizes{10'000, 50'000, 240'000};
constexpr int kMostCompared = 60'000;

/// Steps: as the paper's Cloth scene, the same number of vertices in one sheet, and as its Runway scene.
const std::vector<gpu::StepCase> kSteps{{5, 10'000, kStiffness, kTimeStep},
                                        {1, 50'000, kStiffness, kTimeStep},
                                        {1, 240'000, kStiffness, kTimeStep}};
const std::vector<gpu::StepCase> kQuickSteps{{2, 1'000, kStiffness, kTimeStep}};

/// Sizes of the folded sheet in which near pairs are looked for, and of the dress on a body [vertices].
const std::vector<int> kFoldedSizes{50'000, 240'000};

/// The paper's scenes as made by us, also with its criterion for a step's end, Runway also of a million
/// vertices, and a dance.
const std::vector<gpu::SceneCase> kScenes{
    {"cloth", "scenes/benchmarks/cloth.json", 60, 20},
    {"cloth_by_move", "scenes/benchmarks/cloth.json", 60, 20, 0, StepStop::Move},
    {"runway_60", "scenes/benchmarks/runway.json", 60, 0, 1},
    {"runway_60_by_move", "scenes/benchmarks/runway.json", 60, 0, 1, StepStop::Move},
    {"runway_120", "scenes/benchmarks/runway.json", 60, 0, 2},
    {"runway_240", "scenes/benchmarks/runway.json", 20, 0, 4},
    {"runway_1m", "scenes/benchmarks/runway_1m.json", 5},
    {"dance", "scenes/data/dance.json", 90, 5, 0, {}, true},
};
const std::vector<gpu::SceneCase> kQuickScenes{{"tablecloth", "scenes/demo/tablecloth.json", 8, 8}};

/// Beside other people's methods, at the same states: two steps of a swinging sheet. The paper's rule is made
/// for the smallest only.
const std::vector<gpu::RivalsCase> kRivals{{2'500, 1e3, kTimeStep, 2, 16},
                                           {10'000, 1e3, kTimeStep, 2, 16},
                                           {10'000, 1e4, kTimeStep, 2, 16},
                                           {50'000, 1e3, kTimeStep, 2, 16},
                                           {50'000, 1e4, kTimeStep, 2, 16}};
const std::vector<gpu::RivalsCase> kQuickRivals{{900, 1e3, kTimeStep, 2, 4}};

/// Copies that fit no cache, and such that fit the L2 cache twice [MB].
constexpr int kLargeCopy = 1000, kSmallCopy = 8;

/// What is measured, by name.
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
                     gpu::measure_build(space, vertices, kStiffness, kTimeStep, vertices <= kMostCompared));
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
    for (const gpu::RivalsCase& rivals : options.quick ? kQuickRivals : kRivals)
        cases.push_back(
            {"rivals " + std::to_string(rivals.vertices) + "x" + std::to_string(int(rivals.stiffness)),
             [what = rivals](const CudaSpace& space, gpu::Report& report) {
                 for (solvers::Result& result : gpu::measure_rivals(space, what))
                     report.rivals.push_back(std::move(result));
             }});
    const gpu::RivalsCase small = (options.quick ? kQuickRivals : kRivals).front();
    cases.push_back({"rivals' global solvers", [=](const CudaSpace& space, gpu::Report& report) {
                         gpu::measure_rules(space, small.vertices, small.stiffness, small.dt, report.rules);
                     }});
    std::erase_if(cases, [&](const Case& c) { return c.name.find(options.only) == std::string::npos; });
    if (cases.empty())
        throw InvalidInput("bench gpu: --only \"" + options.only + "\" leaves no case");
    return cases;
}

/// Files and what they hold.
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
    add(kTables[6], !report.rivals.empty(), solvers::csv_table(report.rivals));
    add(kTables[7], !report.rules.empty(), gpu::csv_of(report.rules));
    add(kTables[8], false, gpu::markdown_tables(report));
    return tables;
}

} // namespace

int bench_gpu(const BenchOptions& options)
{
    if (!options.output.empty())
        require_place(options.output, kTables);
    const std::vector<Case> cases = cases_of(options);
    if (const std::string reason = why_no_cuda_device(); !reason.empty())
        throw DeviceError("bench gpu: no CUDA device: " + reason);
    const CudaSpace space(0);
    const InterruptGuard interrupt;
    gpu::Report report;
    report.device = space.device();
    report.copy_gbs = gpu::copy_bandwidth(space, kLargeCopy);
    report.small_copy_gbs = gpu::copy_bandwidth(space, kSmallCopy);
    Progress progress("case", int(cases.size()), options.quiet);
    size_t done = 0;
    while (done < cases.size() && !interrupt.requested()) {
        cases[done].measure(space, report);
        progress.update(int(done) + 1, cases[done].name);
        ++done;
    }

    std::cout << gpu::markdown_tables(report);
    if (done < cases.size()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return kExitFailure;
    }
    write_tables(options.output, tables_of(report, options.only.empty()));
    return kExitOk;
}

} // namespace toile
