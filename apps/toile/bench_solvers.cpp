#include <algorithm>
#include <iostream>
#include <utility>

#include "apps/toile/bench.h"
#include "apps/toile/bench_tables.h"
#include "apps/toile/command_line.h"
#include "apps/toile/interrupt.h"
#include "apps/toile/progress.h"
#include "benchmarks/solvers/run.h"
#include "core/backend/error.h"

namespace toile {

namespace {

using solvers::Method;
using solvers::Problem;

const std::vector<std::string> kTables{"solvers.csv", "solvers.md"};

/// Steps taken from each trajectory: every kStride-th.
constexpr int kSteps = 4;
constexpr int kStride = 8;

std::vector<Problem> problems(bool quick)
{
    if (quick)
        return {Problem::sheet(900, 1e3, 1.0 / 120.0), Problem::skirt(900, 1e3, 1.0 / 60.0)};
    std::vector<Problem> result;
    for (const int vertices : {1000, 2500, 10000})
        for (const double stiffness : {1e2, 1e3, 1e4})
            result.push_back(Problem::sheet(vertices, stiffness, 1.0 / 120.0));
    for (const double dt : {1.0 / 60.0, 1.0 / 30.0})
        result.push_back(Problem::sheet(2500, 1e3, dt));
    result.push_back(Problem::skirt(5000, 1e3, 1.0 / 120.0));
    return result;
}

std::vector<Method> chosen_methods(const BenchOptions& options)
{
    std::vector<Method> methods = solvers::all_methods();
    std::erase_if(methods,
                  [&](const Method& method) { return method.name.find(options.only) == std::string::npos; });
    if (methods.empty())
        throw InvalidInput("--only: no method of solvers has \"" + options.only +
                           "\" in its name; see docs/benchmarks/solvers.md for the names");
    return methods;
}

} // namespace

int bench_solvers(const BenchOptions& options)
{
    if (!options.output.empty())
        require_place(options.output, kTables);
    const std::vector<Method> methods = chosen_methods(options);
    const std::vector<Problem> all = problems(options.quick);
    const InterruptGuard interrupt;
    Progress progress("run", int(all.size() * methods.size()), options.quiet);
    std::vector<solvers::Result> results;
    int done = 0;
    for (const Problem& problem : all) {
        const std::vector<solvers::SampledStep> steps =
            solvers::sample_steps(problem, options.quick ? 2 : kSteps, kStride);
        for (const Method& method : methods) {
            if (interrupt.requested()) {
                std::cerr << "toile: error: interrupted; nothing was written" << std::endl;
                return kExitFailure;
            }
            if (solvers::applies(method, problem))
                results.push_back(solvers::run(problem, steps, method, options.quick ? 1 : options.repeats));
            progress.update(++done, method.name);
        }
    }
    std::cout << markdown_table(results);
    write_tables(options.output, {{kTables[0], csv_table(results)}, {kTables[1], markdown_table(results)}});
    return kExitOk;
}

} // namespace toile
