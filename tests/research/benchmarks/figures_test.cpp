#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "research/benchmarks/paper/figures.h"

namespace toile::research::paper {
namespace {

const Curve::Point& last_of(const std::vector<Curve>& curves, const std::string& problem,
                            const std::string& method, const std::string& loop)
{
    for (const Curve& curve : curves)
        if (curve.problem.find(problem) != std::string::npos && curve.method == method && curve.loop == loop)
            return curve.points.back();
    throw std::runtime_error("no curve of " + method + " with " + loop + " on " + problem);
}

TEST(PaperFigures, SolveTheGlobalStepByQuadratureAndNotByThePapersRule)
{
    const std::vector<Curve> curves = rule_curves({300});
    for (const int figure : {7, 8, 9})
        EXPECT_TRUE(std::any_of(curves.begin(), curves.end(),
                                [&](const Curve& curve) { return curve.figure == figure; }));
    for (const char* problem : {"200000 Pa, drag", "200000 Pa, swing", "1000 N/m, drag", "1000 N/m, swing"}) {
        SCOPED_TRACE(problem);
        for (const char* loop : {"plain", "line search", "pcg"}) {
            EXPECT_LT(last_of(curves, problem, "quadrature (Toile)", loop).error, 1e-9) << loop;
            EXPECT_LT(last_of(curves, problem, "quadrature (Toile)", loop).residual, 1e-9) << loop;
        }
        EXPECT_GT(last_of(curves, problem, "stacked (paper)", "plain").error, 1e6);
        // The length of a step is the best one: the error never grows.
        EXPECT_LE(last_of(curves, problem, "stacked (paper)", "line search").error, 1.0 + 1e-9);
        EXPECT_GT(last_of(curves, problem, "stacked (paper)", "line search").error, 0.1);
    }

    // Figure 8's ranking holds where the kernel reaches half a cell and the force is sharp.
    const auto on_soft_bar = [&](const std::string& method) {
        return last_of(curves, "2000 Pa, drag", method + ", exact denominators", "line search").error;
    };
    EXPECT_LT(on_soft_bar("stacked (paper)"), 0.5 * on_soft_bar("subdivided"));
}

TEST(PaperFigures, TimeTheIterationsThatWereMade)
{
    Curve curve{7, "sheet", "broken", "plain", 0.0, {}};
    const std::vector<int> asked{1, 10};
    trace(
        curve, asked, 0.0, [](int iterations) { return std::min(iterations, 2); }, [](Curve::Point&) {});
    ASSERT_EQ(curve.points.size(), 2u);
    EXPECT_EQ(curve.points[0].iterations, 1);
    EXPECT_EQ(curve.points[1].iterations, 2);
    curve.points[1].ms = 34.0;
    EXPECT_NE(markdown_of({curve}).find(" 17 "), std::string::npos) << markdown_of({curve});
    curve.points[1].iterations = 0;
    EXPECT_EQ(markdown_of({curve}).find("inf"), std::string::npos) << "no iteration, no time for one";
}

TEST(PaperFigures, ConvergeWithContactOnlyBySymmetricPreconditioners)
{
    const std::vector<Curve> curves = contact_curves({300});
    for (const char* problem : {"two bars", "five sheets"}) {
        SCOPED_TRACE(problem);
        EXPECT_LT(last_of(curves, problem, "nested, direct (Toile)", "pcg").error, 0.01);
        EXPECT_LT(last_of(curves, problem, "contact only (Toile)", "pcg").error, 0.01);
        EXPECT_GT(last_of(curves, problem, "nested, direct P_e (paper)", "pcg").error, 0.05);
        EXPECT_GT(last_of(curves, problem, "nested, literal rule (paper)", "pcg").error, 0.5);
    }
}

TEST(PaperFigures, ConvergeOnStepsByEverySolverButThePapersRule)
{
    const std::vector<Curve> curves = step_curves({120});
    for (const char* method : {"direct", "quadrature (Toile)", "Chebyshev", "A-Jacobi", "subspace"})
        for (const char* loop : {"plain", "line search", "l-bfgs"}) {
            const Curve::Point& last = last_of(curves, "bar", method, loop);
            EXPECT_LT(last.error, 0.02) << method << " " << loop;
            EXPECT_LT(last.residual, 0.02) << method << " " << loop;
        }
    for (const char* method : {"JGS2", "Newton (Toile)"})
        EXPECT_LT(last_of(curves, "bar", method, "line search").error, 1e-6) << method;
    EXPECT_GT(last_of(curves, "bar", "paper", "line search").error, 0.5);
    EXPECT_TRUE(std::isinf(last_of(curves, "bar", "paper", "plain").error));

    const std::string csv = csv_of(curves);
    size_t points = 0;
    for (const Curve& curve : curves)
        points += curve.points.size();
    EXPECT_EQ(csv.substr(0, csv.find('\n')),
              "figure,problem,method,loop,setup_ms,iterations,ms,residual,error");
    EXPECT_EQ(size_t(std::count(csv.begin(), csv.end(), '\n')), points + 1);
    // A row for all curves of a method.
    std::set<std::pair<std::string, std::string>> rows;
    for (const Curve& curve : curves)
        rows.emplace(curve.problem, curve.method);
    const std::string markdown = markdown_of(curves);
    EXPECT_EQ(size_t(std::count(markdown.begin(), markdown.end(), '\n')), rows.size() + 2);
}

} // namespace
} // namespace toile::research::paper
