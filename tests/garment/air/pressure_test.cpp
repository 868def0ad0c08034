#include "garment/energy/air/pressure.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Geometry>

#include "tests/garment/gradient_check.h"
#include "tests/garment/sheets.h"

namespace toile::test {

namespace {

constexpr double kPascal = 700.0;

std::shared_ptr<const RestShape> rest_of(const std::vector<Vec3>& x, const std::vector<Triangle>& triangles)
{
    return std::make_shared<const RestShape>(
        rest_shape_of_surface({x, triangles}, Vec3(0.3, 1.0, 0.2), 0.0, "surface"));
}

/// Each triangle split into four, and its vertices moved at random.
TriangleMesh rough(TriangleMesh mesh)
{
    mesh = subdivide(mesh, 1);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(-0.05, 0.05);
    for (Vec3& p : mesh.positions)
        p += Vec3(jitter(random), jitter(random), jitter(random));
    return mesh;
}

TriangleMesh tetrahedron()
{
    return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
            {Triangle(0, 2, 1), Triangle(0, 1, 3), Triangle(0, 3, 2), Triangle(1, 2, 3)}};
}

/// Tetrahedron without two of its faces: one border loop.
TriangleMesh tent()
{
    TriangleMesh mesh = tetrahedron();
    mesh.triangles.resize(2);
    return mesh;
}

Pressure pressure_on(const TriangleMesh& mesh, const std::vector<Vec3>& start)
{
    Pressure pressure(rest_of(mesh.positions, mesh.triangles));
    pressure.begin_step(start, kPascal);
    return pressure;
}

std::vector<Vec3> forces(Pressure& pressure, const std::vector<Vec3>& x)
{
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    pressure.add_gradient(x, gradient);
    for (Vec3& g : gradient)
        g = -g;
    return gradient;
}

/// A third of p A n of each triangle at each of its corners.
std::vector<Vec3> follower_forces(const TriangleMesh& mesh)
{
    std::vector<Vec3> forces(mesh.positions.size(), Vec3::Zero());
    for (const Triangle& t : mesh.triangles) {
        const Vec3 doubled =
            (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
        for (const int v : t)
            forces[v] += kPascal * doubled.norm() / 6.0 * doubled.normalized();
    }
    return forces;
}

Vec3 sum(const std::vector<Vec3>& of)
{
    Vec3 total = Vec3::Zero();
    for (const Vec3& one : of)
        total += one;
    return total;
}

} // namespace

TEST(Pressure, KnowsTheVolumeInside)
{
    TriangleMesh mesh = tetrahedron();
    EXPECT_NEAR(pressure_on(mesh, mesh.positions).volume(mesh.positions), 1.0 / 6.0, 1e-15);
    std::vector<Vec3> moved = mesh.positions;
    const Mat3 rotation = Eigen::AngleAxisd(1.1, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vec3& p : moved)
        p = rotation * p + Vec3(5, -3, 2);
    EXPECT_NEAR(pressure_on(mesh, mesh.positions).volume(moved), 1.0 / 6.0, 1e-14);
    for (Triangle& t : mesh.triangles)
        std::swap(t[0], t[1]);
    EXPECT_NEAR(pressure_on(mesh, mesh.positions).volume(mesh.positions), -1.0 / 6.0, 1e-15);
}

TEST(Pressure, IsClosedWithoutABorder)
{
    EXPECT_TRUE(pressure_on(tetrahedron(), tetrahedron().positions).is_closed());
    EXPECT_FALSE(pressure_on(tent(), tent().positions).is_closed());
}

TEST(Pressure, HasTheGradientOfItsValue)
{
    for (const TriangleMesh& mesh : {tetrahedron(), tent()}) {
        const TriangleMesh start = rough(mesh);
        Pressure pressure = pressure_on(start, start.positions);
        std::vector<Vec3> x = start.positions;
        for (size_t v = 0; v < x.size(); ++v)
            x[v] += 0.1 * Vec3(std::sin(2.0 * double(v)), std::cos(3.0 * double(v)), std::sin(double(v)));
        expect_gradient_of_value(pressure, start.positions);
        expect_gradient_of_value(pressure, x);
    }
}

/// Of closed cloth everywhere, of cloth with a border at the start of the step.
TEST(Pressure, PushesEachTriangleAlongItsNormal)
{
    for (const TriangleMesh& mesh : {rough(tetrahedron()), rough(tent())}) {
        Pressure here = pressure_on(mesh, mesh.positions);
        const std::vector<Vec3> found = forces(here, mesh.positions), expected = follower_forces(mesh);
        for (size_t v = 0; v < found.size(); ++v)
            EXPECT_LT((found[v] - expected[v]).norm(), 1e-12 * kPascal) << "vertex " << v;
    }
    const TriangleMesh mesh = rough(tetrahedron());
    Pressure elsewhere = pressure_on(mesh, rough(mesh).positions);
    const std::vector<Vec3> found = forces(elsewhere, mesh.positions), expected = follower_forces(mesh);
    for (size_t v = 0; v < found.size(); ++v)
        EXPECT_LT((found[v] - expected[v]).norm(), 1e-12 * kPascal) << "vertex " << v;
}

TEST(Pressure, NeitherMovesNorTurnsClosedCloth)
{
    const TriangleMesh mesh = rough(tetrahedron());
    Pressure pressure = pressure_on(mesh, mesh.positions);
    const std::vector<Vec3> found = forces(pressure, mesh.positions);
    Vec3 torque = Vec3::Zero();
    double largest = 0.0;
    for (size_t v = 0; v < found.size(); ++v) {
        torque += mesh.positions[v].cross(found[v]);
        largest = std::max(largest, found[v].norm());
    }
    EXPECT_GT(largest, 0.01 * kPascal);
    EXPECT_LT(sum(found).norm(), 1e-13 * kPascal);
    EXPECT_LT(torque.norm(), 1e-13 * kPascal);
}

/// A fan of 12 triangles, whose border is all of its vertices but one.
TEST(Pressure, PushesADiscByItsArea)
{
    constexpr int kSides = 12;
    TriangleMesh disc{{Vec3::Zero()}, {}};
    const Mat3 tilt = Eigen::AngleAxisd(0.6, Vec3::UnitX()).toRotationMatrix();
    for (int k = 0; k < kSides; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kSides;
        disc.positions.push_back(tilt * Vec3(0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.0));
        disc.triangles.emplace_back(0, 1 + k, 1 + (k + 1) % kSides);
    }
    const double area = kSides * 0.5 * 0.3 * 0.3 * std::sin(2.0 * std::numbers::pi / kSides);
    Pressure pressure = pressure_on(disc, disc.positions);
    EXPECT_LT((sum(forces(pressure, disc.positions)) - kPascal * area * tilt.col(2)).norm(), 1e-12);
    EXPECT_NEAR(pressure.volume(disc.positions), 0.0, 1e-16);

    // A step that moves it without turning it does not change its force.
    std::vector<Vec3> moved = disc.positions;
    for (Vec3& p : moved)
        p += Vec3(0.7, -0.4, 2.0);
    EXPECT_LT((sum(forces(pressure, moved)) - kPascal * area * tilt.col(2)).norm(), 1e-12);
}

TEST(Pressure, IsNothingBeforeTheFirstStepAndAtZero)
{
    const TriangleMesh mesh = rough(tent());
    Pressure pressure(rest_of(mesh.positions, mesh.triangles));
    for (int k = 0; k < 2; ++k) {
        std::vector<Vec3> gradient(mesh.positions.size(), Vec3(1, 2, 3));
        EXPECT_EQ(pressure.add_gradient(mesh.positions, gradient), 0.0);
        for (const Vec3& g : gradient)
            EXPECT_EQ(g, Vec3(1, 2, 3));
        pressure.begin_step(mesh.positions, 0.0);
    }
}

} // namespace toile::test
