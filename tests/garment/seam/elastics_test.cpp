#include "garment/seam/elastics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/hessian_check.h"

namespace toile::test {

using garment::Elastics;

namespace {

constexpr double kStiffness = 30.0;           // [N]
constexpr double kFirst = 0.01, kLast = 0.02; // [m] rest lengths

/// Two springs in a row, of different lengths, and one by itself.
std::shared_ptr<Elastics> springs()
{
    return std::make_shared<Elastics>(std::vector<Elastics::Spring>{
        {0, 1, kFirst, kStiffness}, {1, 2, kLast, kStiffness}, {3, 4, kFirst, 0.5 * kStiffness}});
}

/// Ends with these stretches [-], in directions that no axis has.
std::vector<Vec3> stretched(double first, double second, double third)
{
    const Vec3 along = Vec3(1.0, -2.0, 0.5).normalized(), across = Vec3(0.3, 0.4, -1.0).normalized();
    const Vec3 origin(0.2, 1.1, -0.4);
    return {origin, origin + first * kFirst * along,
            origin + first * kFirst * along + second * kLast * across, -origin,
            -origin - third * kFirst * across};
}

const std::vector<Vec3> kTense = stretched(1.5, 1.02, 3.0), kMixed = stretched(0.7, 1.4, 0.0);

} // namespace

TEST(Elastics, PullInProportionToTheirStrain)
{
    for (const double stretch : {1.0, 1.01, 1.5, 2.0}) {
        const std::vector<Vec3> x = stretched(stretch, 0.5, 0.5);
        std::vector<Vec3> gradient(x.size(), Vec3::Zero());
        const double strain = stretch - 1.0;
        EXPECT_NEAR(springs()->add_gradient(x, gradient), 0.5 * kStiffness * kFirst * strain * strain, 1e-13);
        EXPECT_NEAR(gradient[1].norm(), kStiffness * strain, 1e-12);
        EXPECT_LE((-gradient[0]).dot(x[0] - x[1]), 0.0) << "the force on end 0 points to end 1";
        EXPECT_LT((gradient[0] + gradient[1]).norm(), 1e-15);
    }
}

TEST(Elastics, DoNotPush)
{
    std::vector<Vec3> gradient(5, Vec3::Zero());
    EXPECT_EQ(springs()->add_gradient(stretched(0.99, 0.2, 0.0), gradient), 0.0);
    for (const Vec3& g : gradient)
        EXPECT_EQ(g, Vec3(Vec3::Zero()));
}

/// A row of springs has the tension and the energy of one spring of their length.
TEST(Elastics, AddUpInARow)
{
    const std::vector<Vec3> row{Vec3::Zero(), Vec3(1.3 * kFirst, 0, 0), Vec3(1.3 * (kFirst + kLast), 0, 0)};
    Elastics two({{0, 1, kFirst, kStiffness}, {1, 2, kLast, kStiffness}}),
        one({{0, 2, kFirst + kLast, kStiffness}});
    EXPECT_NEAR(value_of(two, row), value_of(one, row), 1e-15);
    std::vector<Vec3> gradient(3, Vec3::Zero());
    two.add_gradient(row, gradient);
    EXPECT_NEAR(gradient[2].x(), 0.3 * kStiffness, 1e-12);
    EXPECT_NEAR(gradient[1].norm(), 0.0, 1e-12);
}

TEST(Elastics, HaveTheGradientOfTheirValue)
{
    expect_gradient_of_value(*springs(), kTense);
    expect_gradient_of_value(*springs(), kMixed);
}

TEST(Elastics, HaveTheHessianOfTheirGradient)
{
    expect_exact(springs(), kTense);
    expect_exact(springs(), kMixed);
}

TEST(Elastics, HaveAPositiveSemidefiniteHessian)
{
    for (const std::vector<Vec3>& x : {kTense, kMixed, stretched(0.0, 1.0, 0.0)}) {
        const Eigen::MatrixXd H = dense_hessian(springs(), x, Definiteness::Exact);
        EXPECT_TRUE(H.allFinite());
        EXPECT_GT(smallest_eigenvalue(H), -1e-12 * kStiffness / kFirst);
    }
}

TEST(Elastics, LieBelowTheConstantBound)
{
    Triplets entries;
    springs()->add_hessian(entries);
    for (const std::vector<Vec3>& x : {kTense, kMixed}) {
        Eigen::MatrixXd gap = -dense_hessian(springs(), x, Definiteness::Exact);
        for (const auto& entry : entries)
            gap.block<3, 3>(3 * entry.row(), 3 * entry.col()).diagonal().array() += entry.value();
        EXPECT_GT(smallest_eigenvalue(gap), -1e-12 * kStiffness / kFirst);
    }
}

TEST(Elastics, RefuseWhatIsNotPositive)
{
    for (const auto& [rest_length, stiffness] :
         {std::pair{0.0, 1.0}, {0.01, 0.0}, {-0.01, 1.0}, {0.01, std::nan("")}})
        EXPECT_THROW(Elastics({{0, 1, rest_length, stiffness}}), InvalidInput);
}

} // namespace toile::test
