#include "garment/energy/fold/dihedral_angle.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "tests/garment/fold/hinges.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kPi = std::numbers::pi;

/// Angles from -180 to 180 degrees, close to the ends and to 0 too.
std::vector<double> angles()
{
    std::vector<double> result;
    for (int k = -17; k <= 17; ++k)
        result.push_back(k * kPi / 18.0);
    for (const double gap : {1e-1, 1e-3, 1e-6, 1e-9})
        result.insert(result.end(), {kPi - gap, gap - kPi, gap, -gap});
    return result;
}

HingeCorners moved(const HingeCorners& x, int coordinate, double step)
{
    HingeCorners result = x;
    const std::array<Vec3*, 4> corner{&result.v0, &result.v1, &result.a, &result.b};
    (*corner[coordinate / 3])[coordinate % 3] += step;
    return result;
}

} // namespace

TEST(DihedralAngle, IsThatOfItsTrianglesOverTheWholeRange)
{
    for (const double angle : angles())
        EXPECT_NEAR(dihedral_angle(hinge_at(angle)), angle, 1e-14);
}

TEST(DihedralAngle, IsPositiveWhereOuterSidesFaceEachOther)
{
    // Normals of the flat hinge point along z; a corner raised along them is folded to the outside.
    HingeCorners x = hinge_at(0.0);
    x.a += 0.01 * Vec3::UnitZ();
    EXPECT_GT(dihedral_angle(x), 0.1);
}

TEST(DihedralAngle, IsZeroWhereATriangleHasCollapsed)
{
    HingeCorners x = hinge_at(1.0);
    x.a = 0.3 * x.v0 + 0.7 * x.v1;
    EXPECT_EQ(dihedral_angle(x), 0.0);
    EXPECT_TRUE(dihedral_derivatives(x).hessian.allFinite());
    x.v1 = x.v0;
    EXPECT_EQ(dihedral_angle(x), 0.0);
    EXPECT_TRUE(dihedral_derivatives(x).hessian.allFinite());
}

TEST(DihedralGradient, IsTheDerivativeOfTheAngleOverTheWholeRange)
{
    constexpr double kStep = 1e-7;
    for (const double angle : angles()) {
        const HingeCorners x = hinge_at(angle);
        const Eigen::Matrix<double, 12, 1> gradient = dihedral_derivatives(x).gradient;
        for (int i = 0; i < 12; ++i) {
            const double change = dihedral_angle(moved(x, i, kStep)) - dihedral_angle(moved(x, i, -kStep));
            EXPECT_NEAR(gradient[i], std::remainder(change, 2.0 * kPi) / (2.0 * kStep), 1e-5) << angle;
        }
    }
}

TEST(DihedralHessian, IsTheDerivativeOfTheGradientOverTheWholeRange)
{
    constexpr double kStep = 1e-7;
    for (const double angle : angles()) {
        const HingeCorners x = hinge_at(angle);
        const DihedralDerivatives exact = dihedral_derivatives(x);
        const double scale = exact.hessian.cwiseAbs().maxCoeff();
        for (int i = 0; i < 12; ++i) {
            const Eigen::Matrix<double, 12, 1> change = dihedral_derivatives(moved(x, i, kStep)).gradient -
                                                        dihedral_derivatives(moved(x, i, -kStep)).gradient;
            EXPECT_LT((exact.hessian.col(i) - change / (2.0 * kStep)).norm(), 1e-6 * scale) << angle;
        }
    }
}

TEST(DihedralAngle, IsThatOfMovedTriangles)
{
    const Eigen::Matrix3d Q = Eigen::AngleAxisd(2.1, Vec3(0.2, -0.5, 0.8).normalized()).toRotationMatrix();
    const Vec3 shift(0.3, -1.2, 0.7);
    for (const double angle : angles()) {
        const HingeCorners x = hinge_at(angle);
        EXPECT_NEAR(std::remainder(dihedral_angle({Q * x.v0 + shift, Q * x.v1 + shift, Q * x.a + shift,
                                                   Q * x.b + shift}) -
                                       angle,
                                   2.0 * kPi),
                    0.0, 1e-13);
    }
}

} // namespace toile::test
