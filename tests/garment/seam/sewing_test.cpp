#include "garment/seam/sewing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/hessian_check.h"

namespace toile::test {

using garment::gaps_of;
using garment::Sewing;

namespace {

constexpr double kStiffness = 100.0; // [N/m]
constexpr double kMaxForce = 0.05;   // [N]
constexpr double kBound = kMaxForce / kStiffness;

/// Three threads, two of which share a vertex, as darts and T-seams have them.
std::shared_ptr<Sewing> threads()
{
    return std::make_shared<Sewing>(std::vector<Sewing::Thread>{{0, 1}, {1, 2}, {3, 4}},
                                    Sewing::Settings{kStiffness, kMaxForce});
}

/// Ends at these distances, in directions that no axis has.
std::vector<Vec3> at_distances(double first, double second, double third)
{
    const Vec3 along = Vec3(1.0, -2.0, 0.5).normalized(), across = Vec3(0.3, 0.4, -1.0).normalized();
    const Vec3 origin(0.2, 1.1, -0.4);
    return {origin, origin + first * along, origin + first * along + second * across, -origin,
            -origin - third * across};
}

const std::vector<Vec3> kInside = at_distances(0.2 * kBound, 0.9 * kBound, 0.6 * kBound);
const std::vector<Vec3> kOutside = at_distances(40.0 * kBound, 1.3 * kBound, 1000.0 * kBound);

double value_at(double distance) { return value_of(*threads(), at_distances(distance, 0.0, 0.0)); }

} // namespace

TEST(Sewing, HasTheValuesOfASpringAndBeyondTheBoundOfAConstantForce)
{
    EXPECT_EQ(value_at(0.0), 0.0);
    EXPECT_NEAR(value_at(0.5 * kBound), 0.125 * kStiffness * kBound * kBound, 1e-12);
    EXPECT_NEAR(value_at(0.06), kMaxForce * (0.06 - 0.5 * kBound), 1e-12);
    EXPECT_NEAR(value_at(kBound * (1.0 + 1e-9)), value_at(kBound * (1.0 - 1e-9)), 1e-12);
    EXPECT_NEAR(value_at(0.5) - value_at(0.4), 0.1 * kMaxForce, 1e-12);
}

TEST(Sewing, HasTheGradientOfItsValueInsideAndOutsideTheBound)
{
    expect_gradient_of_value(*threads(), kInside);
    expect_gradient_of_value(*threads(), kOutside);
}

TEST(Sewing, PullsBothEndsTogetherWithNoMoreThanTheBound)
{
    for (const double distance : {0.3 * kBound, kBound, 0.01, 3.0}) {
        const std::vector<Vec3> x = at_distances(distance, 0.0, 0.0);
        std::vector<Vec3> gradient(x.size(), Vec3::Zero());
        threads()->add_gradient(x, gradient);
        EXPECT_NEAR(gradient[1].norm(), std::min(kStiffness * distance, kMaxForce), 1e-12);
        EXPECT_LT((-gradient[0]).dot(x[0] - x[1]), 0.0) << "the force on end 0 points to end 1";
        EXPECT_LT((gradient[0] + gradient[1]).norm(), 1e-15);
    }
}

TEST(Sewing, HasTheHessianOfItsGradient)
{
    expect_exact(threads(), kInside);
    expect_exact(threads(), kOutside);
}

TEST(Sewing, HasAPositiveSemidefiniteHessian)
{
    for (const std::vector<Vec3>& x : {kInside, kOutside, at_distances(0.0, 0.0, 0.0)}) {
        expect_semidefinite(threads(), x);
        EXPECT_TRUE(dense_hessian(threads(), x, Definiteness::Exact).allFinite());
    }
}

TEST(Sewing, LiesBelowTheConstantBound)
{
    Triplets entries;
    threads()->add_hessian(entries);
    for (const std::vector<Vec3>& x : {kInside, kOutside}) {
        Eigen::MatrixXd gap = -dense_hessian(threads(), x, Definiteness::Exact);
        for (const auto& entry : entries)
            gap.block<3, 3>(3 * entry.row(), 3 * entry.col()).diagonal().array() += entry.value();
        EXPECT_GT(smallest_eigenvalue(gap), -1e-12 * kStiffness);
    }
}

TEST(Sewing, RefusesSettingsThatAreNotPositive)
{
    for (const Sewing::Settings& settings :
         {Sewing::Settings{0.0, 0.05}, {100.0, 0.0}, {-1.0, 0.05}, {std::nan(""), 0.05}})
        EXPECT_THROW(Sewing({{0, 1}}, settings), InvalidInput);
}

TEST(SeamGaps, NamesTheWidestAndTheMean)
{
    const std::vector<Vec3> x{{0, 0, 0}, {0.01, 0, 0}, {0, 0.03, 0}, {0, 0.03, 0.02}};
    const garment::SeamGaps gaps = gaps_of({{0, 1}, {0, 2}, {2, 3}, {1, 1}}, x);
    EXPECT_DOUBLE_EQ(gaps.max, 0.03);
    EXPECT_EQ(gaps.widest, 1);
    EXPECT_DOUBLE_EQ(gaps.mean, 0.06 / 4.0);
    EXPECT_EQ(gaps_of({}, x).widest, -1);
    EXPECT_EQ(gaps_of({}, x).max, 0.0);
    EXPECT_EQ(gaps_of({{2, 2}}, x).widest, 0) << "closed seams have a widest place too";
}

} // namespace toile::test
