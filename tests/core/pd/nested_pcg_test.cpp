#include "core/pd/preconditioner/nested_pcg.h"

#include <gtest/gtest.h>

#include "core/pd/step/step_objective.h"
#include "tests/core/linear/matrices.h"
#include "tests/core/pd/frozen_terms.h"

namespace toile::test {
namespace {

constexpr double kDt = 0.1;
constexpr int kColumns = 20, kRows = 12, kVertices = kColumns * kRows;

/// W = 1/2 x^T A x
class Quadratic : public Energy {
public:
    std::string_view name() const override { return "test/quadratic"; }
    void add_hessian(Triplets& H) const override
    {
        for (int i = 0; i < A_.outerSize(); ++i)
            for (SparseMatrix::InnerIterator entry(A_, i); entry; ++entry)
                H.emplace_back(i, entry.col(), entry.value());
    }
    double add_gradient(View<const Vec3>, View<Vec3>) override { return 0.0; }

private:
    SparseMatrix A_ = cloth_matrix(kColumns, kRows, 10.0);
};

/// (H + dH) z = g with some fixed vertices.
struct Problem {
    System system{std::vector<double>(kVertices, 1e-4), {std::make_shared<Quadratic>()}};
    std::vector<unsigned char> fixed = std::vector<unsigned char>(kVertices, 0);
    std::vector<Vec3> g = random_field(kVertices, 3);
    FrozenTerms dH;

    explicit Problem(double stiffest = 25.0, int count = 150)
        : dH(coupled_terms(count, kVertices, false, stiffest), kVertices)
    {
        for (const int i : {0, 57, 130}) {
            fixed[i] = 1;
            g[i].setZero();
        }
        system.prepare(kDt, fixed);
    }
    NestedPcg pcg(ContactPreconditioner which, const Pcg::Settings& settings)
    {
        NestedPcg pcg(system, kDt, {which, settings});
        pcg.update(dH);
        return pcg;
    }
    std::vector<Vec3> exact() const
    {
        Eigen::MatrixXd K = dH.dense(fixed);
        for (int i = 0; i < kVertices; ++i)
            for (SparseMatrix::InnerIterator entry(system.matrix(), i); entry; ++entry)
                for (int a = 0; a < 3; ++a)
                    K(3 * i + a, 3 * entry.col() + a) += entry.value();
        const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(g.front().data(), 3 * kVertices);
        const Eigen::VectorXd z = K.llt().solve(b);
        std::vector<Vec3> field(kVertices);
        for (int i = 0; i < kVertices; ++i)
            field[i] = z.segment<3>(3 * i);
        return field;
    }
};

class NestedPcgs : public testing::TestWithParam<ContactPreconditioner> {};

TEST_P(NestedPcgs, ConvergeToTheSolution)
{
    Problem problem;
    std::vector<Vec3> z(kVertices);
    const Pcg::Outcome outcome = problem.pcg(GetParam(), {1e-12, 600}).solve(problem.g, z);
    EXPECT_LE(outcome.residual, 1e-12);
    const Eigen::MatrixX3d exact = as_matrix(problem.exact());
    EXPECT_LT((as_matrix(z) - exact).norm(), 1e-8 * exact.norm());
}

TEST_P(NestedPcgs, AreSymmetricAndPositive)
{
    Problem problem;
    NestedPcg pcg = problem.pcg(GetParam(), {});
    const std::vector<Vec3>& a = problem.g;
    std::vector<Vec3> b = random_field(kVertices, 8), Pa(kVertices), Pb(kVertices);
    for (int i = 0; i < kVertices; ++i)
        if (problem.fixed[i])
            b[i].setZero();
    pcg.precondition(a, Pa);
    pcg.precondition(b, Pb);
    EXPECT_NEAR(dot(a, Pb) / dot(b, Pa), 1.0, 1e-10);
    EXPECT_GT(dot(a, Pa), 0.0);
}

TEST_P(NestedPcgs, EndAtMaxIterations)
{
    Problem problem;
    std::vector<Vec3> z(kVertices);
    const Pcg::Outcome outcome = problem.pcg(GetParam(), {1e-12, 4}).solve(problem.g, z);
    EXPECT_EQ(outcome.iterations, 4);
    EXPECT_GT(outcome.residual, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(All, NestedPcgs,
                         testing::Values(ContactPreconditioner::Block, ContactPreconditioner::Exact,
                                         ContactPreconditioner::ShermanMorrison,
                                         ContactPreconditioner::Chebyshev),
                         name_of);

TEST(NestedPcg, TakesFewerIterationsWithMoreExactContactInverses)
{
    Problem problem;
    std::vector<Vec3> z(kVertices);
    const auto count = [&](ContactPreconditioner which) {
        return problem.pcg(which, {1e-6, 300}).solve(problem.g, z).iterations;
    };
    const int exact = count(ContactPreconditioner::Exact);
    EXPECT_LT(2 * exact, count(ContactPreconditioner::Block));
    EXPECT_LE(count(ContactPreconditioner::Chebyshev), exact + 3);
}

TEST(NestedPcg, DoesNotConvergeWithThePapersPreconditioner)
{
    Problem problem;
    std::vector<Vec3> z(kVertices);
    const Pcg::Outcome outcome = problem.pcg(ContactPreconditioner::Paper, {1e-4, 200}).solve(problem.g, z);
    EXPECT_EQ(outcome.iterations, 200);
    EXPECT_GT(outcome.residual, 0.01);
}

} // namespace
} // namespace toile::test
