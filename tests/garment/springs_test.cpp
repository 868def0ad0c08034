#include "garment/energy/springs.h"

#include <gtest/gtest.h>

namespace toile::test {

using namespace garment;

namespace {

/// Two springs on one vertex, one on another, none on the third.
Springs three_springs()
{
    Springs springs({{0, 2.0}, {2, 5.0}, {0, 3.0}});
    springs.hold(0, Vec3(1, 0, 0));
    springs.hold(1, Vec3(0, 1, 0));
    springs.hold(2, Vec3(0, 0, 1));
    return springs;
}

const std::vector<Vec3> kPositions{Vec3(1, 2, 3), Vec3(4, 5, 6), Vec3(-1, 1, 2)};

TEST(Springs, PullTowardsTheirTargets)
{
    Springs springs = three_springs();
    std::vector<Vec3> gradient(3, Vec3(10, 10, 10)); // added to, not replaced
    const double value = springs.add_gradient(kPositions, gradient);
    EXPECT_EQ(value, 0.5 * (2.0 * 13.0 + 5.0 * 5.0 + 3.0 * 9.0));
    EXPECT_EQ(gradient[0], Vec3(10, 10, 10) + 2.0 * Vec3(0, 2, 3) + 3.0 * Vec3(1, 2, 2));
    EXPECT_EQ(gradient[1], Vec3(10, 10, 10));
    EXPECT_EQ(gradient[2], Vec3(10, 10, 10) + 5.0 * Vec3(-1, 0, 2));
}

TEST(Springs, AddTheirStiffnessToTheDiagonal)
{
    Triplets entries;
    three_springs().add_hessian(entries);
    SparseMatrix H(3, 3);
    H.setFromTriplets(entries.begin(), entries.end());
    EXPECT_EQ(Eigen::Matrix3d(H), Eigen::Matrix3d(Vec3(5.0, 0.0, 5.0).asDiagonal()));
}

TEST(Springs, FollowTheirTargets)
{
    Springs springs = three_springs();
    springs.hold(1, kPositions[2]);
    std::vector<Vec3> gradient(3, Vec3::Zero());
    springs.add_gradient(kPositions, gradient);
    EXPECT_EQ(gradient[2], Vec3(0, 0, 0));
}

TEST(Springs, HoldAgainWhatTheyHaveReleased)
{
    Springs springs = three_springs(), held = three_springs();
    springs.release(1);
    for (Springs* const some : {&springs, &held})
        some->hold(1, Vec3(0, 0, 3));
    std::vector<Vec3> gradient(3, Vec3::Zero()), expected = gradient;
    EXPECT_EQ(springs.add_gradient(kPositions, gradient), held.add_gradient(kPositions, expected));
    EXPECT_EQ(gradient, expected);
}

TEST(Springs, LetGoWhenReleasedAndStillBoundTheirHessian)
{
    Springs springs = three_springs();
    Triplets before, after;
    springs.add_hessian(before);
    springs.release(0);
    springs.add_hessian(after);
    std::vector<Vec3> gradient(3, Vec3::Zero());
    const double value = springs.add_gradient(kPositions, gradient);
    EXPECT_EQ(value, 0.5 * (5.0 * 5.0 + 3.0 * 9.0));
    EXPECT_EQ(gradient[0], 3.0 * Vec3(1, 2, 2));
    EXPECT_EQ(gradient[2], 5.0 * Vec3(-1, 0, 2));
    EXPECT_LE(after.front().value(), before.front().value());
}

} // namespace
} // namespace toile::test
