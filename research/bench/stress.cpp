#include <algorithm>
#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/scratch_folder.h"
#include "research/bench/tables.h"
#include "research/benchmarks/stress/table.h"
#include "scenes/format/field.h"

namespace toile::research {

namespace {

/// Steps between two updates of the progress: the shortest take microseconds.
constexpr int kStepsPerUpdate = 50;

/// Names of the tables; the selected solver is part of them.
std::vector<std::string> table_names(const std::string& solver)
{
    const std::string name = solver.empty() ? "stress" : "stress_" + solver;
    return {name + ".csv", name + ".md"};
}

std::vector<stress::Case> chosen_cases(const BenchOptions& options, const std::filesystem::path& scratch)
{
    std::vector<stress::Case> cases =
        stress::make_cases(options.quick ? stress::Size::Quick : stress::Size::Full, scratch);
    std::erase_if(
        cases, [&](const stress::Case& trial) { return trial.name.find(options.only) == std::string::npos; });
    if (cases.empty())
        throw InvalidInput("--only: no case of stress has \"" + options.only + "\" in its name; see " +
                           "docs/journal/stress.md for the names");
    if (!options.solver.empty())
        for (stress::Case& trial : cases)
            trial.scene.solver.method = scene_format::value_of<scene::SolverMethod>(options.solver);
    return cases;
}

/// Runs all cases until an interrupt.
std::vector<stress::Result> run_all(const std::vector<stress::Case>& cases,
                                    const app::InterruptGuard& interrupt, bool quiet)
{
    int total = 0;
    for (const stress::Case& trial : cases)
        total += trial.steps();
    app::Progress progress("step", total, quiet);
    std::vector<stress::Result> results;
    int done = 0;
    for (const stress::Case& trial : cases) {
        const auto after_step = [&](int step) {
            if (step % kStepsPerUpdate == 0)
                progress.update(done + step, trial.name);
            return !interrupt.requested();
        };
        const stress::Result result = stress::run(trial, stress::Limits{}, after_step);
        if (interrupt.requested())
            break;
        results.push_back(result);
        done += trial.steps();
        progress.update(done, trial.name);
    }
    return results;
}

} // namespace

int bench_stress(const BenchOptions& options)
{
    const std::vector<std::string> names = table_names(options.solver);
    if (!options.output.empty())
        require_writable(options.output, names);
    const ScratchFolder scratch("toile-stress");
    const std::vector<stress::Case> cases = chosen_cases(options, scratch.path());
    const app::InterruptGuard interrupt;
    const std::vector<stress::Result> results = run_all(cases, interrupt, options.quiet);

    std::cout << markdown_table(results);
    if (results.size() < cases.size()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, {{names[0], csv_table(results)}, {names[1], markdown_table(results)}});
    return std::all_of(results.begin(), results.end(), [](const stress::Result& r) { return r.holds; })
               ? app::kExitOk
               : app::kExitFailure;
}

} // namespace toile::research
