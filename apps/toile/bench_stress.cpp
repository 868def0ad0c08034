#include <algorithm>
#include <iostream>

#include <unistd.h>

#include "apps/toile/bench.h"
#include "apps/toile/bench_tables.h"
#include "apps/toile/command_line.h"
#include "apps/toile/interrupt.h"
#include "apps/toile/progress.h"
#include "benchmarks/stress/table.h"
#include "core/backend/error.h"

namespace toile {

namespace {

/// Steps between two looks at the clock: the smallest take microseconds.
constexpr int kStepsPerUpdate = 50;

const std::vector<std::string> kTables{"stress.csv", "stress.md"};

/// A folder for meshes that disappears with the run.
class ScratchFolder {
public:
    ScratchFolder()
        : path_(std::filesystem::temp_directory_path() / ("toile-stress-" + std::to_string(::getpid())))
    {
    }
    ~ScratchFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

std::vector<stress::Case> chosen_cases(const BenchOptions& options, const std::filesystem::path& scratch)
{
    std::vector<stress::Case> cases =
        stress::make_cases(options.quick ? stress::Size::Quick : stress::Size::Full, scratch);
    std::erase_if(
        cases, [&](const stress::Case& trial) { return trial.name.find(options.only) == std::string::npos; });
    if (cases.empty())
        throw InvalidInput("--only: no case of stress has \"" + options.only + "\" in its name; see " +
                           "docs/benchmarks/README.md for the names");
    return cases;
}

/// Runs all cases, or those before an interrupt.
std::vector<stress::Result> run_all(const std::vector<stress::Case>& cases, const InterruptGuard& interrupt,
                                    bool quiet)
{
    int total = 0;
    for (const stress::Case& trial : cases)
        total += trial.steps();
    Progress progress("step", total, quiet);
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
    if (!options.output.empty())
        require_place(options.output, kTables);
    const ScratchFolder scratch;
    const std::vector<stress::Case> cases = chosen_cases(options, scratch.path());
    const InterruptGuard interrupt;
    const std::vector<stress::Result> results = run_all(cases, interrupt, options.quiet);

    std::cout << markdown_table(results);
    if (results.size() < cases.size()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return kExitFailure;
    }
    write_tables(options.output, {{kTables[0], csv_table(results)}, {kTables[1], markdown_table(results)}});
    return std::all_of(results.begin(), results.end(), [](const stress::Result& r) { return r.holds; })
               ? kExitOk
               : kExitFailure;
}

} // namespace toile
