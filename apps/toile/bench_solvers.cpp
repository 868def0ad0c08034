#include <iostream>
#include <numeric>

#include "apps/toile/bench.h"
#include "apps/toile/bench_tables.h"
#include "apps/toile/command_line.h"
#include "apps/toile/interrupt.h"
#include "apps/toile/progress.h"
#include "benchmarks/solvers/run.h"
#include "benchmarks/solvers/suite.h"

namespace toile {

namespace {

const std::vector<std::string> kTables{"solvers.csv"};

/// Methods by vertices, in thousands: what progress counts, since their time is about proportional.
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
    return kExitFailure;
}

} // namespace

int bench_solvers(const BenchOptions& options)
{
    if (!options.output.empty())
        require_place(options.output, kTables);
    const std::vector<solvers::Method> methods = solvers::choose_methods(options.only);
    const std::vector<solvers::Case> cases = solvers::choose_cases(options.mesh, options.quick);
    const int total = std::accumulate(cases.begin(), cases.end(), 0, [&](int sum, const solvers::Case& c) {
        return sum + work(c, methods.size());
    });

    const InterruptGuard interrupt;
    Progress progress("run", total, options.quiet);
    std::vector<solvers::Result> results; // of whole problems: half a one cannot be compared
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
    return kExitOk;
}

} // namespace toile
