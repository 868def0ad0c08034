#include <iostream>
#include <numeric>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/progress.h"
#include "research/bench/benchmark.h"
#include "research/bench/tables.h"
#include "research/benchmarks/solvers/run.h"
#include "research/benchmarks/solvers/suite.h"

namespace toile::research {

namespace {

const std::vector<std::string> kTables{"solvers.csv"};

/// Methods times vertices, in thousands: unit of progress, since run time is about proportional to it.
int work(const solvers::Case& c, size_t methods)
{
    return int(methods) * (1 + c.problem.vertex_count() / 1000);
}

std::vector<TableFile> tables(const std::vector<solvers::Result>& results)
{
    return {{kTables[0], csv_table(results)}};
}

int end_interrupted(const BenchOptions& options, const std::vector<solvers::Result>& finished)
{
    if (!finished.empty())
        write_tables(options.output, tables(finished));
    std::cerr << "toile: error: interrupted; "
              << (finished.empty() || options.output.empty() ? "nothing was written"
                                                             : "only problems that were finished are written")
              << std::endl;
    return app::kExitFailure;
}

} // namespace

int bench_solvers(const BenchOptions& options)
{
    if (!options.output.empty())
        require_writable(options.output, kTables);
    const std::vector<solvers::Method> methods = solvers::choose_methods(options.only);
    const std::vector<solvers::Case> cases = solvers::choose_cases(options.mesh, options.quick);
    const int total = std::accumulate(cases.begin(), cases.end(), 0, [&](int sum, const solvers::Case& c) {
        return sum + work(c, methods.size());
    });

    const app::InterruptGuard interrupt;
    app::Progress progress("run", total, options.quiet);
    std::vector<solvers::Result> results; // complete problems only: partial ones can't be compared
    int done = 0;
    for (const solvers::Case& c : cases) {
        const std::string name = c.problem.mesh + " " + std::to_string(c.problem.vertex_count());
        progress.update(done, name + " reference");
        const std::vector<solvers::SampledStep> steps = solvers::sample_steps(c.problem, c.steps, c.stride);
        std::vector<solvers::Result> of_problem;
        solvers::KeptTables tables_of_problem;
        for (const solvers::Method& method : methods) {
            if (interrupt.requested())
                return end_interrupted(options, results);
            progress.update(done, name + " " + method.name);
            if (solvers::applies(method, c.problem))
                of_problem.push_back(solvers::run(c.problem, steps, method,
                                                  options.quick ? 1 : options.repeats, &tables_of_problem));
            done += work(c, 1);
        }
        results.insert(results.end(), of_problem.begin(), of_problem.end());
    }
    progress.update(total);
    std::cout << markdown_table(results);
    write_tables(options.output, tables(results));
    return app::kExitOk;
}

} // namespace toile::research
