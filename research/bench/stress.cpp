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

/// Cases of cloth and of tetrahedra. A chosen solver.method is of cloth only.
struct Cases {
    std::vector<stress::Case> cloth;
    std::vector<stress::SolidCase> solids;
    size_t count() const { return cloth.size() + solids.size(); }
};

struct Results {
    std::vector<stress::Result> cloth;
    std::vector<stress::SolidResult> solids;
    size_t count() const { return cloth.size() + solids.size(); }
    bool hold() const
    {
        const auto holds = [](const auto& result) { return result.holds; };
        return std::all_of(cloth.begin(), cloth.end(), holds) &&
               std::all_of(solids.begin(), solids.end(), holds);
    }
};

Cases chosen_cases(const BenchOptions& options, const std::filesystem::path& scratch)
{
    const stress::Size size = options.quick ? stress::Size::Quick : stress::Size::Full;
    Cases cases{stress::make_cases(size, scratch), {}};
    if (options.solver.empty())
        cases.solids = stress::make_solid_cases(size);
    const auto is_left_out = [&](const auto& trial) {
        return trial.name.find(options.only) == std::string::npos;
    };
    std::erase_if(cases.cloth, is_left_out);
    std::erase_if(cases.solids, is_left_out);
    if (cases.count() == 0)
        throw InvalidInput("--only: no case of stress has \"" + options.only + "\" in its name; see " +
                           "docs/journal/stress.md for the names");
    if (!options.solver.empty())
        for (stress::Case& trial : cases.cloth)
            trial.scene.solver.method = scene_format::value_of<scene::SolverMethod>(options.solver);
    return cases;
}

/// Runs all cases until an interrupt.
Results run_all(const Cases& cases, const app::InterruptGuard& interrupt, bool quiet)
{
    int total = 0;
    for (const stress::Case& trial : cases.cloth)
        total += trial.steps();
    for (const stress::SolidCase& trial : cases.solids)
        total += trial.steps;
    app::Progress progress("step", total, quiet);
    int done = 0;
    const auto run_each = [&](const auto& trials, const auto& limits, auto& results) {
        for (const auto& trial : trials) {
            const auto after_step = [&](int step) {
                if (step % kStepsPerUpdate == 0)
                    progress.update(done + step, trial.name);
                return !interrupt.requested();
            };
            if (interrupt.requested())
                return;
            const auto result = stress::run(trial, limits, after_step);
            if (interrupt.requested())
                return;
            results.push_back(result);
            done += result.steps;
            progress.update(done, trial.name);
        }
    };
    Results results;
    run_each(cases.cloth, stress::Limits{}, results.cloth);
    run_each(cases.solids, stress::SolidLimits{}, results.solids);
    return results;
}

/// Names of the tables of cloth and of tetrahedra; the selected solver is part of the first.
std::string cloth_table(const std::string& solver) { return solver.empty() ? "stress" : "stress_" + solver; }
const char* const kSolidTable = "stress_solids";

} // namespace

int bench_stress(const BenchOptions& options)
{
    const std::string cloth = cloth_table(options.solver), solids = kSolidTable;
    if (!options.output.empty())
        require_writable(options.output, {cloth + ".csv", cloth + ".md", solids + ".csv", solids + ".md"});
    const ScratchFolder scratch("toile-stress");
    const Cases cases = chosen_cases(options, scratch.path());
    const app::InterruptGuard interrupt;
    const Results results = run_all(cases, interrupt, options.quiet);

    std::vector<TableFile> tables;
    const auto show = [&](const std::string& name, const auto& of) {
        if (of.empty())
            return;
        std::cout << markdown_table(of);
        tables.push_back({name + ".csv", csv_table(of)});
        tables.push_back({name + ".md", markdown_table(of)});
    };
    show(cloth, results.cloth);
    show(solids, results.solids);
    if (results.count() < cases.count()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, tables);
    return results.hold() ? app::kExitOk : app::kExitFailure;
}

} // namespace toile::research
