#include <gtest/gtest.h>

#include <random>

#include <Eigen/LU>
#include <Eigen/SVD>

#include "volume/energy/svd.h"

namespace toile::test {

using namespace volume;

namespace {

Mat3 random_matrix(std::mt19937& random)
{
    std::normal_distribution<double> normal;
    Mat3 F;
    for (int i = 0; i < 9; ++i)
        F(i) = normal(random);
    return F;
}

void expect_svd(const Mat3& F)
{
    const Svd<double> svd = singular_values<double>(F);
    const double scale = std::max(F.norm(), 1e-300);
    EXPECT_LT((svd.U * svd.sigma.asDiagonal() * svd.V.transpose() - F).norm(), 1e-14 * scale) << F;
    for (const Mat3& rotation : {svd.U, svd.V}) {
        EXPECT_LT((rotation.transpose() * rotation - Mat3::Identity()).norm(), 1e-14) << F;
        EXPECT_GT(rotation.determinant(), 0.5) << F;
    }
    const Vec3 expected = Eigen::JacobiSVD<Mat3>(F).singularValues();
    EXPECT_LT((svd.sigma.cwiseAbs() - expected).norm(), 1e-14 * scale) << F;
    EXPECT_GE(svd.sigma[0], svd.sigma[1] - 1e-14 * scale);
    EXPECT_GE(svd.sigma[1], std::abs(svd.sigma[2]) - 1e-14 * scale);
}

TEST(Svd, OfRandomMatrices)
{
    std::mt19937 random(1);
    for (int n = 0; n < 1000; ++n)
        expect_svd(random_matrix(random));
}

TEST(Svd, OfMatricesOfLowRank)
{
    std::mt19937 random(2);
    expect_svd(Mat3::Zero());
    for (int axis = 0; axis < 3; ++axis)
        expect_svd(Vec3::Unit(axis) * Vec3::Unit((axis + 1) % 3).transpose());
    for (int n = 0; n < 100; ++n) {
        const Mat3 A = random_matrix(random), B = random_matrix(random);
        expect_svd(A.col(0) * B.col(0).transpose());
        expect_svd(A.leftCols<2>() * B.leftCols<2>().transpose());
        expect_svd(A * Vec3(1.0, 1e-8, 1e-12).asDiagonal());
        expect_svd(1e50 * A);
        expect_svd(1e-50 * A);
    }
}

TEST(Svd, OfRotationsAndReflections)
{
    std::mt19937 random(3);
    for (int n = 0; n < 100; ++n) {
        const Mat3 R = singular_values<double>(random_matrix(random)).U;
        expect_svd(R);
        expect_svd(-R);
        EXPECT_LT((singular_values<double>(-R).sigma - Vec3(1.0, 1.0, -1.0)).norm(), 1e-14);
        expect_svd(R * Vec3(2.0, 2.0, 1.0).asDiagonal() * R.transpose());
    }
}

TEST(Svd, OfEightMatricesAtOnceIsThatOfEach)
{
    std::mt19937 random(4);
    std::vector<Mat3> F;
    for (int k = 0; k < kLanes; ++k)
        F.push_back(k == 3 ? Mat3::Zero() : random_matrix(random));
    Mat3Of<Lanes> all;
    for (int i = 0; i < 9; ++i)
        all(i) = gather(0, kLanes, [&](int k) { return F[k](i); });
    const Svd<Lanes> svd = singular_values<Lanes>(all);
    for (int k = 0; k < kLanes; ++k) {
        const Svd<double> one = singular_values<double>(F[k]);
        for (int i = 0; i < 9; ++i) {
            EXPECT_NEAR(svd.U(i)[k], one.U(i), 1e-13);
            EXPECT_NEAR(svd.V(i)[k], one.V(i), 1e-13);
        }
    }
}

} // namespace
} // namespace toile::test
