#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <Eigen/Geometry>

#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kWarp = 300.0, kWeft = 200.0, kShear = 40.0; // [N/m]

std::shared_ptr<Membrane> membrane_of(const std::shared_ptr<const RestShape>& rest)
{
    return std::make_shared<Membrane>(rest, Membrane::Settings{kWarp, kWeft, kShear}, "sheet");
}

/// Smoothly and reproducibly crumpled sheet.
std::vector<Vec3> crumpled(const Sheet& sheet)
{
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x)
        p += 0.02 *
             Vec3(std::sin(31 * p.x() + 7 * p.z()), std::cos(23 * p.z()), std::sin(19 * p.x() * p.z() + 1));
    return x;
}

TEST(Membrane, HasTheGradientOfItsValue)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 5, 5, Pattern::Irregular);
    expect_gradient_of_value(*membrane_of(sheet.rest()), crumpled(sheet));
}

TEST(Bending, HasTheGradientOfItsValue)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 5, 5, Pattern::Irregular);
    Bending bending(sheet.rest(), Bending::Settings{0.02, 0.01}, "sheet");
    expect_gradient_of_value(bending, crumpled(sheet));
}

TEST(Membrane, HasYoungsModulusAlongTheYarns)
{
    const Sheet sheet = make_sheet(Vec2(0.5, 0.4), 4, 4);
    const auto membrane = membrane_of(sheet.rest());
    const double strain = 1e-3, area = 0.2;
    std::vector<Vec3> warp = sheet.flat(), weft = sheet.flat(), sheared = sheet.flat();
    for (size_t v = 0; v < warp.size(); ++v) {
        warp[v].x() *= 1.0 + strain;
        weft[v].z() *= 1.0 + strain;
        sheared[v].x() += strain * sheared[v].z();
    }
    EXPECT_NEAR(value_of(*membrane, warp) / (0.5 * kWarp * strain * strain * area), 1.0, 1e-9);
    EXPECT_NEAR(value_of(*membrane, weft) / (0.5 * kWeft * strain * strain * area), 1.0, 1e-9);
    EXPECT_NEAR(value_of(*membrane, sheared) / (0.5 * kShear * strain * strain * area), 1.0, 1e-3);
}

TEST(Bending, CostsACylinderHalfItsRigidityTimesCurvatureSquared)
{
    // Rolled along the warp on any mesh: W = D_u / 2 per area and curvature squared, borders apart.
    const double radius = 2.0, D = 3e-5;
    for (const Pattern pattern : {Pattern::Regular, Pattern::FlippedDiagonal, Pattern::Irregular}) {
        const Sheet sheet = make_sheet(Vec2(1.0, 0.5), 60, 30, pattern);
        Bending bending(sheet.rest(), Bending::Settings{D, 0.0}, "sheet");
        std::vector<Vec3> x = sheet.flat();
        for (size_t v = 0; v < x.size(); ++v) {
            const double angle = sheet.uv[v].x() / radius;
            x[v] = Vec3(radius * std::sin(angle), radius * std::cos(angle), sheet.uv[v].y());
        }
        EXPECT_NEAR(value_of(bending, x) / (0.5 * D / (radius * radius) * 0.5), 1.0, 0.02);
    }
}

TEST(Energies, CostNothingUnderRigidMotion)
{
    const Sheet sheet = make_sheet(Vec2(0.3, 0.2), 6, 4, Pattern::Irregular);
    const Mat3 rotation = Eigen::AngleAxisd(2.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x)
        p = rotation * p + Vec3(10, -5, 3);
    Bending bending(sheet.rest(), Bending::Settings{1e-5, 2e-5}, "sheet");
    EXPECT_LT(value_of(*membrane_of(sheet.rest()), x), 1e-24);
    EXPECT_LT(value_of(bending, x), 1e-18); // rounding: K |x|^2 eps; a visible fold costs 1e-7 J
}

TEST(Body, KeepsLinearMomentum)
{
    const Sheet sheet = make_sheet(Vec2(0.3, 0.3), 8, 8, Pattern::Irregular);
    const auto rest = sheet.rest();
    const std::vector<std::shared_ptr<Energy>> energies{
        membrane_of(rest), std::make_shared<Bending>(rest, Bending::Settings{1e-5, 1e-5}, "sheet")};
    Body::Settings settings;
    settings.tolerance = 1e-10;
    settings.max_iterations = 500;
    const std::vector<double> masses = masses_of(*rest, 0.15);
    Body body(crumpled(sheet), std::make_unique<System>(masses, energies), settings);
    std::vector<Vec3> v(masses.size());
    for (size_t i = 0; i < v.size(); ++i)
        v[i] = Vec3(0.3 + std::sin(5.0 * double(i)), -0.2, 0.1 * std::cos(3.0 * double(i)));
    body.set_velocities(v);
    const auto momentum = [&] {
        Vec3 sum = Vec3::Zero();
        for (size_t i = 0; i < masses.size(); ++i)
            sum += masses[i] * body.velocities()[int(i)];
        return sum;
    };
    const Vec3 before = momentum();
    const std::vector<Vec3> nothing(v.size(), Vec3::Zero());
    for (int step = 0; step < 20; ++step)
        (void)body.step(0.01, nothing, std::vector<unsigned char>(v.size(), 0), nothing, nullptr, nullptr);
    EXPECT_LT((momentum() - before).norm(), 1e-6 * before.norm());
}

TEST(Bending, AddsNothingToHWhenTheMembraneDominates)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 10, 10);
    const auto rest = sheet.rest();
    const std::vector<double> diagonal = hessian_diagonal(*membrane_of(rest), rest->vertex_count());
    Bending cotton(rest, Bending::Settings{2e-6, 2e-6}, "cotton"),
        board(rest, Bending::Settings{1.0, 1.0}, "board");
    EXPECT_TRUE(cotton.leave_to(diagonal));
    EXPECT_FALSE(board.leave_to(diagonal));
    EXPECT_EQ(hessian_diagonal(cotton, rest->vertex_count()), std::vector<double>(rest->vertex_count(), 0.0));
    EXPECT_GT(hessian_diagonal(board, rest->vertex_count())[60], 0.0);
    expect_gradient_of_value(cotton, crumpled(sheet));
}

} // namespace
} // namespace toile::test
