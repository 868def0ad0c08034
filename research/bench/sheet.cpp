#include <algorithm>
#include <iostream>
#include <optional>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "core/base/process_usage.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/sheet/table.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"sheet.csv", "sheet.md"};

/// Settings whose name was selected, with their references unless only times count.
std::vector<sheet::Setting> chosen_settings(const BenchOptions& options)
{
    std::vector<sheet::Setting> settings = sheet::ladder();
    const auto asked_for = [&](const sheet::Setting& setting) {
        return setting.name.find(options.only) != std::string::npos;
    };
    if (std::none_of(settings.begin(), settings.end(), asked_for))
        throw InvalidInput("--only: no setting of sheet has \"" + options.only +
                           "\" in its name; see docs/journal/cpu_speed.md for the names");
    std::erase_if(settings, [&](const sheet::Setting& setting) {
        if (options.times_only && !sheet::is_timed(setting))
            return true;
        return !setting.is_reference && !asked_for(setting);
    });
    return settings;
}

/// Number of runs: one for references, which take a minute each and whose times do not count.
int runs_of(const sheet::Setting& setting, const BenchOptions& options)
{
    return sheet::is_timed(setting) && !options.quick ? options.repeats : 1;
}

/// Runs all settings, each with its own progress display; stops at an interrupt.
std::vector<sheet::Result> run_all(const sheet::Sheet& sheet, const std::vector<sheet::Setting>& settings,
                                   const BenchOptions& options, const app::InterruptGuard& interrupt)
{
    std::vector<sheet::Result> results;
    for (const sheet::Setting& setting : settings) {
        const int runs = runs_of(setting, options);
        app::Progress progress("step", runs * sheet.steps, options.quiet);
        std::optional<sheet::Result> best;
        for (int k = 0; k < runs; ++k) {
            sheet::Result result = sheet::run(sheet, setting, [&](int step) {
                progress.update(k * sheet.steps + step, setting.name);
                return !interrupt.requested();
            });
            if (interrupt.requested())
                return results;
            best = best ? sheet::faster(std::move(*best), std::move(result)) : std::move(result);
        }
        results.push_back(std::move(*best));
    }
    return results;
}

} // namespace

int bench_sheet(const BenchOptions& options)
{
    if (!options.output.empty())
        require_writable(options.output, kTables);
    const sheet::Sheet sheet = options.quick ? sheet::quick_sheet() : sheet::full_sheet();
    const std::vector<sheet::Setting> settings = chosen_settings(options);
    const app::InterruptGuard interrupt;
    std::vector<sheet::Result> results = run_all(sheet, settings, options, interrupt);
    sheet::compare(sheet, results);

    std::cout << markdown_table(sheet, results) << "\npeak memory " << peak_memory() / (1024 * 1024)
              << " MiB\n";
    if (results.size() < settings.size()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output,
                 {{kTables[0], csv_table(sheet, results)}, {kTables[1], markdown_table(sheet, results)}});
    return app::kExitOk;
}

} // namespace toile::research
