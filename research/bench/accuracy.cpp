#include <algorithm>
#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/scratch_folder.h"
#include "research/bench/tables.h"
#include "research/benchmarks/accuracy/run.h"

namespace toile::research {

namespace {

/// Names of the tables; a backend other than the default is part of them.
std::vector<std::string> table_names(const std::string& backend)
{
    const std::string name = backend == "cpu" ? "accuracy" : "accuracy_" + backend;
    return {name + ".csv", name + ".md"};
}

std::vector<accuracy::Case> chosen_cases(const BenchOptions& options, const std::filesystem::path& scratch)
{
    std::vector<accuracy::Case> cases = accuracy::make_cases(scratch, options.quick);
    std::erase_if(cases, [&](const accuracy::Case& trial) {
        return trial.name.find(options.only) == std::string::npos;
    });
    if (cases.empty())
        throw InvalidInput("--only: no case of accuracy has \"" + options.only + "\" in its name");
    return cases;
}

} // namespace

int bench_accuracy(const BenchOptions& options)
{
    const std::vector<std::string> names = table_names(options.backend);
    if (!options.output.empty())
        require_writable(options.output, names);
    const ScratchFolder scratch("toile-accuracy");
    const std::vector<accuracy::Case> cases = chosen_cases(options, scratch.path());
    int total = 0;
    for (const accuracy::Case& trial : cases)
        total += accuracy::frames_of(trial);

    const app::InterruptGuard interrupt;
    app::Progress progress("frame", total, options.quiet);
    scenes::WorldOptions world;
    world.backend = options.backend == "cuda" ? scenes::Backend::Cuda : scenes::Backend::Cpu;
    std::vector<accuracy::Result> results;
    int done = 0;
    for (const accuracy::Case& trial : cases) {
        const auto after_frame = [&] {
            progress.update(++done, trial.name);
            return !interrupt.requested();
        };
        const accuracy::Result result = accuracy::run(trial, world, after_frame);
        if (interrupt.requested())
            break;
        results.push_back(result);
    }

    std::cout << markdown_table(results);
    if (results.size() < cases.size()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, {{names[0], csv_table(results)}, {names[1], markdown_table(results)}});
    return std::all_of(results.begin(), results.end(), [](const accuracy::Result& r) { return r.holds; })
               ? app::kExitOk
               : app::kExitFailure;
}

} // namespace toile::research
