#include <iostream>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "core/base/error.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/error_time/run.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"error_time.csv", "error_time.md"};

std::vector<accuracy::Case> chosen_problems(const BenchOptions& options)
{
    std::vector<accuracy::Case> problems = error_time::problems(options.quick);
    std::erase_if(problems, [&](const accuracy::Case& problem) {
        return problem.name.find(options.only) == std::string::npos;
    });
    if (problems.empty())
        throw InvalidInput("--only: no problem of error_time has \"" + options.only + "\" in its name");
    return problems;
}

} // namespace

int bench_error_time(const BenchOptions& options)
{
    if (!options.output.empty())
        require_writable(options.output, kTables);
    const std::vector<accuracy::Case> problems = chosen_problems(options);
    const std::vector<error_time::Contender> contenders = error_time::contenders(options.quick);
    int total = 0;
    for (const accuracy::Case& problem : problems)
        total += error_time::frames_of(problem, contenders);

    const app::InterruptGuard interrupt;
    app::Progress progress("frame", total, options.quiet);
    std::vector<error_time::Point> points;
    int done = 0;
    for (const accuracy::Case& problem : problems) {
        const auto of_problem = error_time::run(problem, contenders, [&](const std::string& name) {
            progress.update(++done, name);
            return !interrupt.requested();
        });
        points.insert(points.end(), of_problem.begin(), of_problem.end());
        if (interrupt.requested())
            break;
    }

    std::cout << markdown_table(points);
    if (interrupt.requested()) {
        std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
        return app::kExitFailure;
    }
    write_tables(options.output, {{kTables[0], csv_table(points)}, {kTables[1], markdown_table(points)}});
    return app::kExitOk;
}

} // namespace toile::research
