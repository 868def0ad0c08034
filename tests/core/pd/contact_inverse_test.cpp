#include <gtest/gtest.h>

#include "core/linear/field.h"
#include "core/pd/preconditioner/chebyshev_inverse.h"
#include "core/pd/preconditioner/nested_pcg.h"
#include "tests/core/linear/matrices.h"
#include "tests/core/pd/frozen_terms.h"

namespace toile::test {

namespace {

constexpr int kVertices = 60;
constexpr double kStiffest = 50.0; // about 25 times D

/// Diagonal, fixed vertices and right-hand sides for the variants.
struct Question {
    std::vector<double> D;
    std::vector<unsigned char> fixed;

    explicit Question(bool fixes_some = true)
    {
        for (int i = 0; i < kVertices; ++i) {
            D.push_back(1.0 + 0.5 * std::sin(3.0 * i));
            fixed.push_back(fixes_some && i % 9 == 4 ? 1 : 0);
        }
    }
    std::vector<Vec3> forces(unsigned seed) const
    {
        std::vector<Vec3> r = random_field(kVertices, seed);
        for (int i = 0; i < kVertices; ++i)
            if (fixed[i])
                r[i].setZero();
        return r;
    }
    std::vector<Vec3> answer(ContactInverse& E, const FrozenTerms& dH, const std::vector<Vec3>& r) const
    {
        std::vector<Vec3> z(kVertices);
        E.update(dH, D, fixed);
        E.apply(r, z);
        return z;
    }
    Eigen::MatrixXd matrix(const FrozenTerms& dH) const
    {
        Eigen::MatrixXd A = dH.dense(fixed);
        for (int i = 0; i < kVertices; ++i)
            A.diagonal().segment<3>(3 * i).array() += D[i];
        return A;
    }
};

Eigen::VectorXd numbers(const std::vector<Vec3>& field)
{
    return Eigen::Map<const Eigen::VectorXd>(field.front().data(), 3 * long(field.size()));
}

FrozenTerms dense_terms() { return {coupled_terms(80, kVertices, false, kStiffest), kVertices}; }
FrozenTerms disjoint_terms() { return {coupled_terms(12, kVertices, true, kStiffest), kVertices}; }

/// |E r - (D + dH)^-1 r| relative to |(D + dH)^-1 r|, in the norm of D + dH.
double error(ContactPreconditioner which, const FrozenTerms& dH, const Question& question)
{
    const std::vector<Vec3> r = question.forces(5);
    const std::vector<Vec3> z = question.answer(*make_contact_inverse(which), dH, r);
    const Eigen::MatrixXd A = question.matrix(dH);
    const Eigen::VectorXd exact = A.llt().solve(numbers(r));
    const Eigen::VectorXd e = numbers(z) - exact;
    return std::sqrt(e.dot(A * e) / exact.dot(A * exact));
}

class ContactInverses : public testing::TestWithParam<ContactPreconditioner> {};

TEST_P(ContactInverses, AreSymmetricPositiveDefiniteAndLinear)
{
    const Question question;
    for (const FrozenTerms& dH : {dense_terms(), disjoint_terms()})
        for (unsigned seed = 1; seed <= 5; ++seed) {
            const std::unique_ptr<ContactInverse> E = make_contact_inverse(GetParam());
            const std::vector<Vec3> a = question.forces(seed), b = question.forces(100 + seed);
            const std::vector<Vec3> Ea = question.answer(*E, dH, a), Eb = question.answer(*E, dH, b);
            EXPECT_NEAR(dot(a, Eb), dot(b, Ea), 1e-12);
            EXPECT_GT(dot(a, Ea), 0.0);
            std::vector<Vec3> sum = a;
            axpy(2.0, b, sum);
            const std::vector<Vec3> E_sum = question.answer(*E, dH, sum);
            for (int i = 0; i < kVertices; ++i)
                EXPECT_LT((E_sum[i] - Ea[i] - 2.0 * Eb[i]).norm(), 1e-12);
        }
}

TEST_P(ContactInverses, LeaveFixedVerticesUnchanged)
{
    const Question question;
    const std::vector<Vec3> z =
        question.answer(*make_contact_inverse(GetParam()), dense_terms(), question.forces(5));
    for (int i = 0; i < kVertices; ++i)
        EXPECT_EQ(z[i].norm() == 0.0, question.fixed[i] == 1) << i;
}

TEST_P(ContactInverses, AreExactForTermsOfOneVertex)
{
    std::vector<FrozenTerm> terms(30);
    std::mt19937 random(2);
    for (int i = 0; i < 30; ++i) {
        terms[i].vertex[0] = (7 * i) % 20; // some twice
        terms[i].weight[0] = 1.0;
        terms[i].stiffness = random_stiffness(kStiffest, random);
    }
    EXPECT_LT(error(GetParam(), {terms, kVertices}, Question()), 1e-14);
}

TEST_P(ContactInverses, ForgetThePreviousActiveSet)
{
    const Question question;
    const std::vector<Vec3> r = question.forces(5);
    const std::unique_ptr<ContactInverse> used = make_contact_inverse(GetParam());
    (void)question.answer(*used, dense_terms(), r);
    EXPECT_EQ(question.answer(*used, disjoint_terms(), r),
              question.answer(*make_contact_inverse(GetParam()), disjoint_terms(), r));
}

INSTANTIATE_TEST_SUITE_P(All, ContactInverses,
                         testing::Values(ContactPreconditioner::Block, ContactPreconditioner::Exact,
                                         ContactPreconditioner::ShermanMorrison,
                                         ContactPreconditioner::Chebyshev),
                         name_of);

TEST(ExactInverse, IsTheInverse)
{
    EXPECT_LT(error(ContactPreconditioner::Exact, dense_terms(), Question()), 1e-13);
    EXPECT_LT(error(ContactPreconditioner::Exact, disjoint_terms(), Question()), 1e-13);
    EXPECT_GT(error(ContactPreconditioner::Block, dense_terms(), Question()), 0.3);
}

TEST(ShermanMorrisonInverse, IsTheInverseForDisjointTerms)
{
    const auto which = ContactPreconditioner::ShermanMorrison;
    EXPECT_LT(error(which, disjoint_terms(), Question()), 1e-13);
    EXPECT_LT(error(which, disjoint_terms(), Question(false)), 1e-13);
    EXPECT_GT(error(ContactPreconditioner::Block, disjoint_terms(), Question()), 0.1);
}

TEST(ShermanMorrisonInverse, IsTheBoundForTermsThatShareVertices)
{
    EXPECT_EQ(error(ContactPreconditioner::ShermanMorrison, dense_terms(), Question()),
              error(ContactPreconditioner::Block, dense_terms(), Question()));
}

TEST(ChebyshevInverse, KeepsItsContractionBound)
{
    for (const double stiffest : {0.5, 5.0, 50.0}) {
        const FrozenTerms dH(coupled_terms(40, kVertices, false, stiffest), kVertices);
        const Question question;
        ChebyshevInverse E;
        E.update(dH, question.D, question.fixed);
        ASSERT_LT(E.step_count(), ChebyshevInverse::kMaxSteps) << stiffest;
        EXPECT_LE(error(ContactPreconditioner::Chebyshev, dH, question), ChebyshevInverse::kContraction);
    }
}

TEST(ChebyshevInverse, StopsAtMaxSteps)
{
    const FrozenTerms dH(coupled_terms(40, kVertices, false, 1e6), kVertices);
    const Question question;
    ChebyshevInverse E;
    E.update(dH, question.D, question.fixed);
    EXPECT_EQ(E.step_count(), ChebyshevInverse::kMaxSteps);
}

} // namespace
} // namespace toile::test
