#include "apps/toile/fit/garment_girth.h"

#include <gtest/gtest.h>

#include "tests/apps/fit/tubes.h"

namespace toile::test {

using namespace app;

namespace {

constexpr double kBody = 0.15; ///< [m] radius

/// Girth of a body at a point of it, for a tape across `normal`.
avatars::Girth girth_at(const TriangleMesh& body, const Vec3& point, const Vec3& normal = Vec3::UnitY())
{
    avatars::Girth girth;
    girth.key = "waist";
    girth.plane = avatars::SectionPlane::through(point, normal);
    for (const avatars::SectionLoop& loop : avatars::cut(body, girth.plane))
        if ((loop.center - point).norm() < kBody)
            girth.skin = loop;
    girth.length = avatars::closed_length(girth.skin.points);
    return girth;
}

GirthFit fit_at(const Vec3& point, const TriangleMesh& garment, const TriangleMesh& body,
                double stretch = 1.0)
{
    return fit_girths(garment, flat(garment, stretch), body, {girth_at(body, point)}).at(0);
}

const Vec3 kMiddle(0.0, 0.537, 0.0);

TEST(GarmentGirth, HasTheEaseOfATubeAroundACylinder)
{
    const GirthFit fit = fit_at(kMiddle, tube(0.2), tube(kBody));
    ASSERT_TRUE(fit.garment);
    EXPECT_EQ(fit.not_covered, "");
    EXPECT_NEAR(fit.garment->draped, circumference() * 0.2, 1e-12);
    EXPECT_NEAR(fit.garment->rest, circumference() * 0.2, 1e-12);
    EXPECT_NEAR(fit.ease(), circumference() * (0.2 - kBody), 1e-12);
    EXPECT_NEAR(fit.ease(), 2.0 * std::numbers::pi * 0.05, 1e-3);
}

TEST(GarmentGirth, HasNegativeEaseWhereTheClothIsStretched)
{
    const GirthFit fit = fit_at(kMiddle, tube(0.16), tube(kBody), 1.25);
    ASSERT_TRUE(fit.garment);
    EXPECT_NEAR(fit.garment->draped, circumference() * 0.16, 1e-12);
    EXPECT_NEAR(fit.garment->rest, circumference() * 0.128, 1e-12);
    EXPECT_NEAR(fit.ease(), circumference() * (0.128 - kBody), 1e-12);
}

TEST(GarmentGirth, IsMeasuredAcrossALimbInAnyDirection)
{
    const Eigen::Matrix3d Q = Eigen::AngleAxisd(1.1, Vec3(1.0, 2.0, -0.5).normalized()).toRotationMatrix();
    TriangleMesh garment = tube(0.2), body = tube(kBody);
    for (TriangleMesh* mesh : {&garment, &body})
        for (Vec3& x : mesh->positions)
            x = Q * x;
    const GirthFit fit =
        fit_girths(garment, flat(garment), body, {girth_at(body, Q * kMiddle, Q.col(1))}).at(0);
    ASSERT_TRUE(fit.garment);
    EXPECT_NEAR(fit.ease(), circumference() * 0.05, 1e-12);
}

TEST(GarmentGirth, IsThatOfTheTightestLayer)
{
    const GirthFit fit = fit_at(kMiddle, together(tube(0.25), tube(0.2)), tube(kBody));
    ASSERT_TRUE(fit.garment);
    EXPECT_NEAR(fit.ease(), circumference() * 0.05, 1e-12);
}

TEST(GarmentGirth, IsNoneWhereTheGarmentDoesNotSurroundTheBody)
{
    const TriangleMesh body = tube(kBody);
    const GirthFit above = fit_at(kMiddle, moved(tube(0.2), Vec3(0.0, 0.6, 0.0)), body);
    EXPECT_FALSE(above.garment);
    EXPECT_EQ(above.not_covered, "no cloth goes around it");
    const GirthFit beside = fit_at(kMiddle, moved(tube(0.2), Vec3(0.5, 0.0, 0.0)), body);
    EXPECT_FALSE(beside.garment);
    EXPECT_EQ(beside.not_covered, "no cloth goes around it");
    const GirthFit open = fit_at(kMiddle, tube(0.2, true), body);
    EXPECT_FALSE(open.garment);
    EXPECT_EQ(open.not_covered, "the garment ends or is open there");
    TriangleMesh halves = tube(0.2); // a front and a back, open at the armholes
    std::erase_if(halves.triangles,
                  [&](const Triangle& t) { return std::abs(halves.positions[size_t(t[0])].x()) > 0.18; });
    const GirthFit armholes = fit_at(kMiddle, halves, body);
    EXPECT_FALSE(armholes.garment);
    EXPECT_EQ(armholes.not_covered, "the garment ends or is open there");
}

/// A skirt has no ease at a thigh; trousers have.
TEST(GarmentGirth, IsNoneWhereTheGarmentGoesAroundTwoLegs)
{
    const Vec3 left(0.2, 0.0, 0.0), right(-0.2, 0.0, 0.0);
    const TriangleMesh legs = together(moved(tube(kBody), left), moved(tube(kBody), right));
    const GirthFit skirt = fit_at(kMiddle + left, tube(0.5), legs);
    EXPECT_FALSE(skirt.garment);
    EXPECT_EQ(skirt.not_covered, "the garment goes around other parts of the body too");

    const TriangleMesh trousers = together(moved(tube(0.18), left), moved(tube(0.19), right));
    const GirthFit leg = fit_at(kMiddle + right, trousers, legs);
    ASSERT_TRUE(leg.garment);
    EXPECT_NEAR(leg.ease(), circumference() * 0.04, 1e-12);
}

TEST(GarmentGirth, OfAThighIsMeasuredBelowTheForkOfTrousers)
{
    const Vec3 left(0.2, 0.0, 0.0), right(-0.2, 0.0, 0.0), down(0.0, -0.5, 0.0);
    const TriangleMesh legs = together(moved(tube(kBody), left), moved(tube(kBody), right));
    const auto trousers = [&](const Vec3& fork) { // at y = 0.5 + fork
        return together(moved(tube(0.5), fork - down), together(moved(tube(0.18), left + down + fork),
                                                                moved(tube(0.19), right + down + fork)));
    };
    avatars::Girth thigh = girth_at(legs, kMiddle + right);
    thigh.key = "leg_circ";
    const auto fit = [&](const TriangleMesh& garment) {
        return fit_girths(garment, flat(garment), legs, {thigh}).at(0);
    };
    const GirthFit below = fit(trousers(Vec3::Zero()));
    ASSERT_TRUE(below.garment);
    EXPECT_NEAR(below.lowered, 0.04, 1e-12) << "from 0.537 m";
    EXPECT_NEAR(below.body.skin.center.y(), 0.497, 1e-12);
    EXPECT_NEAR(below.body.length, circumference() * kBody, 1e-12);
    EXPECT_NEAR(below.ease(), circumference() * 0.04, 1e-12);
    const GirthFit too_low = fit(trousers(Vec3(0.0, -0.07, 0.0)));
    EXPECT_FALSE(too_low.garment);
    EXPECT_EQ(too_low.lowered, 0.0);
}

} // namespace
} // namespace toile::test
