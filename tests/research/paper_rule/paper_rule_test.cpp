#include "research/paper_rule/paper_rule.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/compute/parallel.h"
#include "core/linear/direct_solver.h"
#include "core/linear/field.h"
#include "research/benchmarks/quadrature/sheet.h"
#include "tests/core/compute/teams_on_cpu.h"
#include "tests/core/linear/matrices.h"
#include "tests/core/mesh/meshes.h"

namespace toile::test {

using namespace research;

namespace {

constexpr int kSide = 21;

std::vector<unsigned char> none_fixed(const Sheet& sheet)
{
    return std::vector<unsigned char>(sheet.vertex_count(), 0);
}

PaperRule prepared(const Sheet& sheet, const SparseMatrix& H, Denominator denominator)
{
    PaperRule::Settings settings;
    settings.denominator = denominator;
    PaperRule rule(sheet.uv, sheet.triangles, settings);
    rule.update(H, none_fixed(sheet));
    return rule;
}

std::vector<Vec3> solve(const GlobalSolver& solver, const std::vector<Vec3>& b)
{
    std::vector<Vec3> x(b.size());
    solver.solve(b, x);
    return x;
}

std::vector<Vec3> solve_exactly(const SparseMatrix& H, const std::vector<Vec3>& b)
{
    std::vector<Vec3> x(b.size());
    Cholesky(H).solve(b, x);
    return x;
}

/// |x - exact| / |exact|
double relative_error(const std::vector<Vec3>& x, const std::vector<Vec3>& exact)
{
    return (as_matrix(x) - as_matrix(exact)).norm() / as_matrix(exact).norm();
}

/// b - H x
std::vector<Vec3> residual(const SparseMatrix& H, const std::vector<Vec3>& b, const std::vector<Vec3>& x)
{
    std::vector<Vec3> r = b;
    for (int i = 0; i < int(b.size()); ++i)
        r[i] -= row_times(H, i, x);
    return r;
}

TEST(PaperRule, ReadsFortyThreeVerticesOfANode)
{
    const Sheet sheet = unit_sheet(kSide, 0.2);
    const PaperRule rule = prepared(sheet, sheet_matrix(sheet, 100.0), Denominator::Exact);
    EXPECT_FALSE(rule.is_symmetric());
    for (int i = 0; i < sheet.vertex_count(); ++i) {
        EXPECT_LE(rule.row(i).size(), 8 + 3 * 9 + 8 + 3) << i; // a few components may add clusters
        EXPECT_TRUE(std::any_of(rule.row(i).begin(), rule.row(i).end(),
                                [&](const WeightedVertex& entry) { return entry.vertex == i; }));
    }
}

TEST(PaperRule, IsAccurateToTensOfPercentForSmoothLoads)
{
    const Sheet sheet = unit_sheet(kSide, 0.2);
    for (const auto& [k, max_error] : {std::pair(10.0, 0.35), std::pair(100.0, 0.45), std::pair(1e4, 0.15)}) {
        const SparseMatrix H = sheet_matrix(sheet, k);
        const std::vector<Vec3> b = smooth_load(sheet);
        const double error =
            relative_error(solve(prepared(sheet, H, Denominator::Exact), b), solve_exactly(H, b));
        EXPECT_LT(error, max_error) << k;
        EXPECT_GT(error, 0.05) << k;
    }
}

TEST(PaperRule, IsInaccurateWithItsOwnDenominator)
{
    // H u is a spike at one vertex, and the rule weighs it as if it were smooth.
    const Sheet sheet = unit_sheet(kSide, 0.2);
    const SparseMatrix H = sheet_matrix(sheet, 100.0);
    const std::vector<Vec3> b = smooth_load(sheet);
    const double error =
        relative_error(solve(prepared(sheet, H, Denominator::SameRule), b), solve_exactly(H, b));
    EXPECT_GT(error, 0.9);
}

TEST(PaperRule, DoesNotContractAsAnIteration)
{
    const Sheet sheet = unit_sheet(kSide, 0.2);
    for (const double k : {10.0, 100.0})
        for (const Denominator denominator : {Denominator::Exact, Denominator::SameRule}) {
            const SparseMatrix H = sheet_matrix(sheet, k);
            const std::vector<Vec3> b = smooth_load(sheet), exact = solve_exactly(H, b);
            const PaperRule rule = prepared(sheet, H, denominator);
            std::vector<Vec3> x = solve(rule, b);
            for (int iteration = 0; iteration < 10; ++iteration)
                axpy(1.0, solve(rule, residual(H, b, x)), x);
            EXPECT_GT(relative_error(x, exact), 1e4) << k;
        }
}

TEST(PaperRule, StallsUnderALineSearch)
{
    // The step that minimises the energy 1/2 x.Hx - b.x along the direction, of either sign.
    const Sheet sheet = unit_sheet(kSide, 0.2);
    const SparseMatrix H = sheet_matrix(sheet, 100.0);
    const std::vector<Vec3> b = smooth_load(sheet), exact = solve_exactly(H, b);
    const PaperRule rule = prepared(sheet, H, Denominator::Exact);
    std::vector<Vec3> x(b.size(), Vec3::Zero());
    const auto energy = [&] { return 0.5 * (dot(x, residual(H, b, x)) * -1.0 - dot(b, x)); };
    double before = energy();
    for (int iteration = 0; iteration < 30; ++iteration) {
        const std::vector<Vec3> r = residual(H, b, x), z = solve(rule, r);
        const std::vector<Vec3> Hz = residual(H, std::vector<Vec3>(b.size(), Vec3::Zero()), z);
        axpy(dot(z, r) / -dot(z, Hz), z, x);
        const double after = energy();
        EXPECT_LE(after, before + 1e-9 * std::abs(before));
        before = after;
    }
    EXPECT_LT(relative_error(x, exact), 1.0);
    EXPECT_GT(relative_error(x, exact), 0.5); // a direct solve converges in one
}

/// The paper's loop applies the rule to the whole b of a global step, not to the residual. Cloth at its exact
/// solution moves by more than an edge.
TEST(PaperRule, DisplacesAnExactSolution)
{
    const Sheet sheet = unit_sheet(kSide, 0.2);
    const double edge = 1.0 / (kSide - 1);
    std::vector<Vec3> field;
    for (const Vec2& p : sheet.uv)
        field.emplace_back(p.x(), 0.0, p.y());
    for (const double k : {100.0, 1e3, 1e4})
        for (const Denominator denominator : {Denominator::Exact, Denominator::SameRule}) {
            const SparseMatrix H = sheet_matrix(sheet, k);
            std::vector<Vec3> b(field.size(), Vec3::Zero());
            for (int i = 0; i < int(b.size()); ++i)
                b[i] = row_times(H, i, field);
            std::vector<Vec3> found = solve(prepared(sheet, H, denominator), b);
            axpy(-1.0, field, found);
            const double moved = as_matrix(found).norm() / std::sqrt(double(found.size())) / edge;
            EXPECT_GT(moved, 1.0) << k << " N/m, denominator " << int(denominator);
        }
}

/// Flags of two corners and the middle as fixed.
std::vector<unsigned char> some_fixed(const Sheet& sheet)
{
    std::vector<unsigned char> fixed = none_fixed(sheet);
    fixed[0] = fixed[kSide - 1] = fixed[kSide * 10 + 10] = 1;
    return fixed;
}

TEST(PaperRule, IsAppliedAgainToTheResidual)
{
    const Sheet sheet = unit_sheet(kSide, 0.2);
    const std::vector<unsigned char> fixed = some_fixed(sheet);
    const SparseMatrix H = sheet_matrix(sheet, 100.0, fixed);
    const std::vector<Vec3> b = smooth_load(sheet);
    const auto applied = [&](int applications) {
        PaperRule::Settings settings;
        settings.applications = applications;
        PaperRule rule(sheet.uv, sheet.triangles, settings);
        rule.update(H, fixed);
        return solve(rule, b);
    };
    PaperRule once(sheet.uv, sheet.triangles);
    once.update(H, fixed);
    std::vector<Vec3> expected = solve(once, b);
    EXPECT_EQ(applied(1), expected);
    for (int applications = 2; applications <= 3; ++applications) {
        axpy(1.0, solve(once, residual(H, b, expected)), expected);
        EXPECT_LT(relative_error(applied(applications), expected), 1e-12) << applications;
    }
}

/// By teams of threads, as on a GPU.
TEST(PaperRule, MatchesTeamsOfThreads)
{
    const Sheet sheet = unit_sheet(kSide, 0.2);
    const SparseMatrix H = sheet_matrix(sheet, 100.0);
    const PaperRule rule = prepared(sheet, H, Denominator::Exact);
    const std::vector<Vec3> b = smooth_load(sheet), expected = solve(rule, b);
    std::vector<Vec3> x(b.size(), Vec3::Constant(NAN));
    run_teams<WeightedRows::kThreads>(int(b.size()), ApplyRule{rule.rule(), b, x});
    EXPECT_LT(relative_error(x, expected), 1e-14);
    std::vector<Vec3> doubled = b;
    axpy(1.0, b, doubled);
    run_teams<WeightedRows::kThreads>(int(b.size()), CorrectByRule{rule.rule(), b, x});
    EXPECT_LT(relative_error(x, solve(rule, doubled)), 1e-14);
}

TEST(PaperRule, KeepsFixedVerticesAndReadsNothingFromThem)
{
    const Sheet sheet = unit_sheet(kSide);
    const std::vector<unsigned char> fixed = some_fixed(sheet);
    const SparseMatrix H = sheet_matrix(sheet, 100.0, fixed);
    PaperRule rule(sheet.uv, sheet.triangles);
    rule.update(H, fixed);
    std::vector<Vec3> b = smooth_load(sheet);
    const std::vector<Vec3> x = solve(rule, b);
    for (int i = 0; i < sheet.vertex_count(); ++i)
        if (fixed[i]) {
            EXPECT_EQ(x[i], b[i]);
            b[i] *= -1e6;
        }
    const std::vector<Vec3> other = solve(rule, b);
    for (int i = 0; i < sheet.vertex_count(); ++i)
        EXPECT_TRUE(fixed[i] || x[i] == other[i]) << i;
}

TEST(PaperRule, GivesTheSameBitsForEveryThreadCountAndInPlace)
{
    const Sheet sheet = unit_sheet(kSide);
    const SparseMatrix H = sheet_matrix(sheet, 10.0);
    const std::vector<Vec3> b = smooth_load(sheet);
    std::vector<Vec3> one;
    {
        const ThreadLimit limit(1);
        one = solve(prepared(sheet, H, Denominator::SameRule), b);
    }
    std::vector<Vec3> many = b;
    prepared(sheet, H, Denominator::SameRule).solve(many, many);
    EXPECT_EQ(one, many);
}

TEST(PaperRule, RefusesAMatrixOfAnotherSize)
{
    const Sheet sheet = unit_sheet(5);
    PaperRule rule(sheet.uv, sheet.triangles);
    EXPECT_EQ(message_of([&] { rule.update(grid_laplacian(3, 3, 0.1), std::vector<unsigned char>(25, 0)); }),
              "paper rule: H has 9 rows and 25 vertices may be fixed, but the mesh has 25");
}

TEST(PaperRule, NamesASettingOutOfRange)
{
    const Sheet sheet = unit_sheet(5);
    const auto message = [&](auto change) {
        PaperRule::Settings settings;
        change(settings);
        return message_of([&] { PaperRule rule(sheet.uv, sheet.triangles, settings); });
    };
    EXPECT_EQ(message([](PaperRule::Settings& s) { s.rule.order = 5; }),
              "paper rule: order is 5; 3 or 4 needed");
    EXPECT_NE(
        message([](PaperRule::Settings& s) { s.rule.domains.near_influence = 0.95; }).find("near_influence"),
        std::string::npos);
    EXPECT_EQ(message([](PaperRule::Settings& s) { s.rule.domains.near_influence = -1e-9; }),
              "paper rule: near_influence is -1e-09; above 0 and at most middle_influence needed");
    EXPECT_NE(message([](PaperRule::Settings& s) { s.rule.penalty = NAN; }).find("penalty"),
              std::string::npos);
    EXPECT_EQ(message([](PaperRule::Settings& s) { s.applications = 0; }),
              "paper rule: applications is 0; at least 1 needed");
    EXPECT_NE(message([](PaperRule::Settings& s) { s.voxels = 0; }).find("0 voxels"), std::string::npos);
}

} // namespace
} // namespace toile::test
