/// contact_solver [THREADS [SECONDS [CONTACTS]]]: measures the variants of the nested preconditioner, as CSV
/// on stdout. Times are the minimum of the repetitions within SECONDS (0.3), on one thread by default.
/// `ratio` is the time to a residual of 1e-4, set-up included, over that of the block variant. CONTACTS: only
/// that kind.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <utility>

#include "core/compute/parallel.h"
#include "core/pd/preconditioner/nested_pcg.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/contact_solver/cases.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::contact_solver {

namespace {

constexpr int kCap = 300; // iterations

struct Variant {
    const char* name;
    ContactPreconditioner preconditioner;
    bool is_flexible = false;
};
constexpr Variant kVariants[] = {{"block", ContactPreconditioner::Block},
                                 {"exact", ContactPreconditioner::Exact},
                                 {"sherman-morrison", ContactPreconditioner::ShermanMorrison},
                                 {"chebyshev", ContactPreconditioner::Chebyshev},
                                 {"paper", ContactPreconditioner::Paper},
                                 {"paper flexible", ContactPreconditioner::Paper, true}};

constexpr std::pair<Kind, const char*> kKinds[] = {{Kind::Floor, "floor"},
                                                   {Kind::Disjoint, "disjoint"},
                                                   {Kind::Stack, "stack"},
                                                   {Kind::Sticking, "stack sticking"},
                                                   {Kind::Bars, "bars"}};

/// Measurement of a variant on a case.
struct Measurement {
    const Case& problem;
    Variant variant;
    NestedPcg nested{problem.system(), Case::kDt, {variant.preconditioner, {}}};
    std::vector<Vec3> z = std::vector<Vec3>(problem.forces().size());

    void update() { nested.update(problem.contact()); }

    Pcg::Outcome solve(double tolerance, int cap)
    {
        const auto K = [&](View<const Vec3> p, View<Vec3> out) { nested.multiply(p, out); };
        const auto P = [&](View<const Vec3> r, View<Vec3> out) { nested.precondition(r, out); };
        return Pcg().solve(K, P, problem.forces(), z, {tolerance, cap, variant.is_flexible});
    }

    /// Iterations to residuals of 1e-1, 1e-2, 1e-4 and 1e-8, up to the first that exceeds the cap.
    void append_counts(Row& row)
    {
        bool is_reached = true;
        for (const double tolerance : {1e-1, 1e-2, 1e-4, 1e-8}) {
            if (!is_reached) {
                row.emplace_back("-");
                continue;
            }
            const Pcg::Outcome outcome = solve(tolerance, kCap);
            is_reached = outcome.residual <= tolerance;
            row.push_back(is_reached ? std::to_string(outcome.iterations)
                                     : "left " + format("%.2g", outcome.residual));
        }
    }
};

/// @param block_ms  of the block variant, which comes first: out
Row measure(const Case& problem, const Variant& variant, double seconds, double& block_ms)
{
    constexpr double kTimed = 1e-4;
    Measurement at_work{problem, variant};
    const double update_ms = best_ms(seconds, [&] { at_work.update(); });
    int iterations = 0;
    const double solve_ms = best_ms(seconds, [&] { iterations = at_work.solve(kTimed, kCap).iterations; });
    if (variant.preconditioner == ContactPreconditioner::Block)
        block_ms = update_ms + solve_ms;

    Row row{variant.name};
    at_work.append_counts(row);
    for (const int cap : {3, 10})
        row.push_back(format("%.2g", at_work.solve(0.0, cap).residual));
    row.push_back(format("%.3f", update_ms));
    row.push_back(format("%.3f", solve_ms / std::max(iterations, 1)));
    row.push_back(format("%.2f", (update_ms + solve_ms) / block_ms));
    return row;
}

void measure_all(double seconds, const std::string& only)
{
    const Row header{"contacts",          "vertices",  "terms",        "stiffness", "preconditioner",
                     "to_1e-1",           "to_1e-2",   "to_1e-4",      "to_1e-8",   "residual_after_3",
                     "residual_after_10", "update_ms", "iteration_ms", "ratio"};
    std::fputs(csv(header, {}).c_str(), stdout);
    for (const int vertices : {2000, 10000})
        for (const auto& [kind, kind_name] : kKinds)
            for (const double stiffness : {collision::Contact::Settings{}.stiffness, 25.0}) {
                if (!only.empty() && only != kind_name)
                    continue;
                const Case problem(kind, vertices, stiffness);
                double block_ms = 0.0;
                for (const Variant& variant : kVariants) {
                    Row row{kind_name, std::to_string(problem.system().vertex_count()),
                            std::to_string(problem.term_count()), format("%g", stiffness)};
                    const Row measured = measure(problem, variant, seconds, block_ms);
                    row.insert(row.end(), measured.begin(), measured.end());
                    std::fputs(csv(row, {}).c_str(), stdout);
                    std::fflush(stdout);
                }
            }
}

} // namespace

} // namespace toile::research::contact_solver

int main(int argc, char** argv)
{
    using namespace toile;
    using namespace toile::research;
    try {
        const ThreadLimit limit(argc > 1 ? std::atoi(argv[1]) : 1);
        contact_solver::measure_all(argc > 2 ? std::atof(argv[2]) : 0.3, argc > 3 ? argv[3] : "");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "contact_solver: %s\n", error.what());
        return 1;
    }
    return 0;
}
