#include <cstdlib>
#include <memory>

#include <CLI/CLI.hpp>

#include "apps/toile/terminal/command_line.h"
#include "core/base/blas_memory.h"
#include "core/compute/cuda/runtime/runtime.h"
#include "research/bench/benchmark.h"
#include "research/scenes/literature_methods.h"
#include "scenes/format/field.h"

namespace toile::research {

namespace {

/// Options that only some benchmarks support.
enum Option : unsigned {
    kOnly = 1,
    kMesh = 2,
    kScenes = 4,
    kSolver = 8,
    kRepeats = 16,
    kThreads = 32,
    kTimesOnly = 64,
    kBackend = 128
};

struct Benchmark {
    const char* name;
    const char* summary;
    int (*run)(const BenchOptions& options);
    unsigned options; ///< bits of Option, besides the common ones
};

constexpr Benchmark kBenchmarks[] = {
    {"accuracy", "Default settings against exact and converged values: error, aim, milliseconds per frame",
     bench_accuracy, kOnly | kBackend},
    {"contact", "Cloth on cloth: crossings under stress, cost by part against size, with and without it",
     bench_contact, kOnly | kThreads},
    {"error_time",
     "Whole scenes at default and other settings, and by methods of the literature: error, milliseconds",
     bench_error_time, kOnly},
    {"figures", "The paper's figures 7 to 9, 11 and 12 on a CPU: residual and error by iteration",
     bench_figures, kOnly},
    {"gpu", "One GPU: the global solve by pass, beside the CPU and the card's bandwidth", bench_gpu, kOnly},
    {"paper", "The volumetric scenes of the paper's Table 1 on one GPU, beside its figures", bench_paper,
     kScenes},
    {"scaling", "A tablecloth of 1 000 to 80 000 vertices: milliseconds per frame, memory per vertex",
     bench_scaling, kScenes},
    {"sheet", "A hanging sheet of 10 000 vertices: milliseconds per step against the error", bench_sheet,
     kOnly | kRepeats | kTimesOnly},
    {"solvers", "The same steps by every global solver, XPBD and VBD: milliseconds against the error",
     bench_solvers, kOnly | kMesh | kRepeats},
    {"stages", "Scenes: milliseconds per frame by stage, iterations, contacts, peak memory", bench_stages,
     kScenes | kRepeats},
    {"stress", "Extreme steps, materials, meshes and starts: finite, no energy gained, back to rest",
     bench_stress, kOnly | kSolver},
};

/// Check of an option: empty, or what is wrong.
std::string at_least_two(const std::string& frames)
{
    return std::atoi(frames.c_str()) < 2 ? frames + " leaves nothing to simulate; give 2 or more"
                                         : std::string();
}

void add_options(CLI::App& add, BenchOptions& options, unsigned which)
{
    add.add_option("-o,--output", options.output, "Folder for the table as CSV and Markdown");
    if (which & kOnly)
        add.add_option("--only", options.only, "Only cases whose name contains this");
    if (which & kMesh)
        add.add_option("--mesh", options.mesh, "sheet, skirt, drape or bar, or NAME:VERTICES");
    if (which & kScenes) {
        add.add_option("scenes", options.scenes, "Scene files (.json)");
        add.add_option("--frames", options.frames, "Samples of each scene, instead of its own")
            ->check(at_least_two);
    }
    if (which & kSolver)
        add.add_option("--solver", options.solver, "solver.method of all cases")
            ->check(CLI::IsMember(scene_format::words_of<scene::SolverMethod>()));
    if (which & kBackend)
        add.add_option("--backend", options.backend, "cpu or cuda; converged runs are the CPU's [cpu]")
            ->check(CLI::IsMember({"cpu", "cuda"}));
    if (which & kRepeats)
        add.add_option("--repeats", options.repeats,
                       "Runs of everything that is timed; the fastest counts [3]")
            ->check(CLI::PositiveNumber);
    if (which & kThreads)
        add.add_option("--threads", options.threads, "Threads of every run [all]")
            ->check(CLI::PositiveNumber);
    if (which & kTimesOnly)
        add.add_flag("--times-only", options.times_only, "Without references and errors");
    add.add_flag("--quick", options.quick, "Smaller and shorter cases");
    add.add_flag("--quiet", options.quiet, "No progress on stderr");
}

app::Command add_benchmark(CLI::App& parser, const Benchmark& benchmark)
{
    app::Command command;
    command.options = parser.add_subcommand(benchmark.name, benchmark.summary);
    auto options = std::make_shared<BenchOptions>();
    add_options(*command.options, *options, benchmark.options);
    command.run = [options, run = benchmark.run] { return run(*options); };
    return command;
}

std::vector<app::Command> add_commands(CLI::App& parser)
{
    static const LiteratureMethods baselines;
    std::vector<app::Command> commands{app::add_simulate(parser, &baselines)};
    for (const Benchmark& benchmark : kBenchmarks)
        commands.push_back(add_benchmark(parser, benchmark));
    return commands;
}

} // namespace

} // namespace toile::research

int main(int argc, char** argv)
{
    toile::leave_out_blas_threads(argv);
    toile::cuda::load_kernels_eagerly();
    return toile::app::run_command_line(argc, argv,
                                        {"toile-bench",
                                         "Measures Toile, also beside methods of the literature.",
                                         toile::research::add_commands});
}
