#include "apps/toile/bench.h"

#include <algorithm>
#include <iostream>
#include <memory>

#include "apps/toile/command_line.h"
#include "apps/toile/commands.h"
#include "core/backend/error.h"
#include "scenes/format/field.h"

namespace toile {

namespace {

struct Benchmark {
    const char* name;
    const char* summary;
    int (*run)(const BenchOptions& options);
};

constexpr Benchmark kBenchmarks[] = {
    {"contact", "cloth on cloth: crossings under stress, cost by part against size, with and without it",
     bench_contact},
    {"gpu", "one GPU: the global solve by pass, beside the CPU and the card's bandwidth", bench_gpu},
    {"sheet", "a hanging sheet of 10 000 vertices: milliseconds per step against the error", bench_sheet},
    {"solvers", "the same steps by every global solver, XPBD and VBD: milliseconds against the error",
     bench_solvers},
    {"stages", "scenes: milliseconds per frame by stage, iterations, contacts, peak memory", bench_stages},
    {"stress", "extreme steps, materials, meshes and starts: finite, no energy gained, back to rest",
     bench_stress},
};

int list()
{
    for (const Benchmark& benchmark : kBenchmarks)
        std::cout << benchmark.name << "  " << benchmark.summary << "\n";
    return kExitOk;
}

int bench(const BenchOptions& options)
{
    if (options.name.empty())
        return list();
    if (options.name != "stages" && (!options.scenes.empty() || options.frames))
        throw InvalidInput("bench " + options.name + ": takes no scenes and no --frames; only stages does");
    if (options.name != "stress" && !options.solver.empty())
        throw InvalidInput("bench " + options.name + ": takes no --solver; only stress does");
    if (options.name != "solvers" && !options.mesh.empty())
        throw InvalidInput("bench " + options.name + ": takes no --mesh; only solvers does");
    if (options.name != "contact" && options.threads != 0)
        throw InvalidInput("bench " + options.name + ": takes no --threads; only contact does");
    std::vector<std::string> names;
    for (const Benchmark& benchmark : kBenchmarks) {
        if (options.name == benchmark.name)
            return benchmark.run(options);
        names.emplace_back(benchmark.name);
    }
    const std::string near = nearest_word(options.name, names);
    throw InvalidInput("unknown benchmark \"" + options.name + "\"; " +
                       (near.empty() ? "toile bench lists them" : "did you mean \"" + near + "\"?"));
}

} // namespace

Command add_bench(CLI::App& program)
{
    Command command;
    command.options = program.add_subcommand("bench", "Run a benchmark and print its table");
    auto options = std::make_shared<BenchOptions>();
    CLI::App& add = *command.options;
    add.add_option("name", options->name, "Benchmark; without one, all are listed");
    add.add_option("-o,--output", options->output, "Folder for the table as CSV and Markdown");
    add.add_option("--only", options->only, "Only cases whose name contains this");
    add.add_option("--mesh", options->mesh, "sheet, skirt or drape, or NAME:VERTICES; only for solvers");
    add.add_option("scenes", options->scenes, "Scene files (.json); only for stages");
    add.add_option("--frames", options->frames, "Samples of each scene, instead of its own; only for stages");
    add.add_option("--solver", options->solver, "solver.method of all cases; only for stress")
        ->check(CLI::IsMember(scene_format::words_of<scene::SolverMethod>()));
    add.add_option("--repeats", options->repeats, "Runs of everything that is timed; the fastest counts [3]")
        ->check(CLI::PositiveNumber);
    add.add_option("--threads", options->threads, "Threads of every run; only for contact [all]")
        ->check(CLI::PositiveNumber);
    add.add_flag("--times-only", options->times_only, "Without references and errors; only for sheet");
    add.add_flag("--quick", options->quick, "Smaller and shorter cases");
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return bench(*options); };
    return command;
}

} // namespace toile
