#include "garment/energy/membrane_kernels.h"

#include <gtest/gtest.h>

#include <random>

namespace toile::test {

using namespace garment;

namespace {

/// Deformation gradients: random ones, the identity, a collapsed one and one with a collapsed yarn.
std::vector<Mat32> deformation_gradients()
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> value(-1.5, 1.5);
    std::vector<Mat32> F(kLanes);
    for (Mat32& gradient : F)
        for (int k = 0; k < 6; ++k)
            gradient(k) = value(random);
    F[2] = Mat32::Identity();
    F[4] << 1.0, 0.5, 2.0, 1.0, -4.0, -2.0;
    F[5].col(0).setZero();
    return F;
}

TEST(MembraneKernels, MatchInLanesAndOneByOne)
{
    const std::vector<Mat32> F = deformation_gradients();
    Mat2 rest_inv;
    rest_inv << 90.0, 0.0, -40.0, 110.0;
    const MembraneWeights weights{120.0, 80.0, 60.0};
    Mat32Of<Lanes> side_by_side;
    for (int k = 0; k < 6; ++k)
        side_by_side(k) = gather(0, kLanes, [&](int lane) { return F[lane](k); });
    Mat2Of<Lanes> rest_inv_of_all;
    for (int k = 0; k < 4; ++k)
        rest_inv_of_all(k) = Lanes(rest_inv(k));
    const MembraneResponse<Lanes> all =
        project_membrane<Lanes>(side_by_side, rest_inv_of_all, Lanes(5e-5), weights);

    for (int lane = 0; lane < kLanes; ++lane) {
        const MembraneResponse<double> one = project_membrane<double>(F[lane], rest_inv, 5e-5, weights);
        EXPECT_NEAR(all.energy[lane], one.energy, 1e-14 * (1.0 + one.energy)) << lane;
        for (int k = 0; k < 6; ++k)
            EXPECT_NEAR(all.corner_gradient(k)[lane], one.corner_gradient(k), 1e-12) << lane;
    }
}

TEST(MembraneKernels, GiveACollapsedTriangleNoShearForce)
{
    Mat32 F = Mat32::Zero();
    F.col(0) = Vec3(1, 0, 0);
    F.col(1) = Vec3(2, 0, 0);
    EXPECT_EQ(closest_isometry<double>(F), F);
}

} // namespace
} // namespace toile::test
