#include "garment/energy/air/aerodynamics.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kDensity = 1.2, kNormal = 1.1, kTangential = 0.04;
constexpr double kArealDensity = 0.15; // [kg/m^2]
constexpr double kGravity = 9.81;

/// Rigid flat sheet in the air: the acceleration is applied without any other force.
struct Flight {
    Sheet sheet = make_sheet(Vec2(0.4, 0.3), 4, 3, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<double> masses;
    std::vector<Vec3> x = sheet.flat(), v;
    Aerodynamics air{rest, {kDensity, kNormal, kTangential}};
    Vec3 wind = Vec3::Zero(), gravity = Vec3::Zero();

    explicit Flight(double areal_density = kArealDensity) : masses(masses_of(*rest, areal_density))
    {
        v.assign(x.size(), Vec3::Zero());
    }

    std::vector<Vec3> acceleration(double dt)
    {
        std::vector<Vec3> a(x.size(), gravity);
        air.add_acceleration(x, v, masses, wind, dt, a);
        return a;
    }
    /// Moves every vertex with the mean acceleration, like a stiff sheet.
    void step(double dt)
    {
        Vec3 mean = Vec3::Zero();
        for (const Vec3& a : acceleration(dt))
            mean += a / double(x.size());
        for (size_t i = 0; i < x.size(); ++i) {
            v[i] += dt * mean;
            x[i] += dt * v[i];
        }
    }

    /// Steps of dt [s] for `duration` [s]; then expects the velocity `terminal` at every vertex.
    void expect_terminal_velocity(const Vec3& terminal, double dt, double duration)
    {
        for (int k = 0; k < int(duration / dt); ++k)
            step(dt);
        EXPECT_LT((v[0] - terminal).norm(), 1e-6 * terminal.norm()) << "dt = " << dt;
        for (const Vec3& a : acceleration(dt))
            EXPECT_LT(a.norm(), 1e-5 * kGravity) << "dt = " << dt;
    }
};

TEST(Aerodynamics, LetsAFlatSheetFallAtItsTerminalVelocity)
{
    // Weight against drag: rho_A g = rho c v^2 / 2, whatever the time step.
    for (const double dt : {1.0 / 480.0, 1.0 / 120.0, 1.0 / 30.0}) {
        Flight flight;
        flight.gravity = Vec3(0.0, -kGravity, 0.0);
        const double terminal = std::sqrt(2.0 * kArealDensity * kGravity / (kDensity * kNormal));
        flight.expect_terminal_velocity(Vec3(0.0, -terminal, 0.0), dt, 3.0);
    }
}

TEST(Aerodynamics, SlidesAlongTheSheetWithTheTangentialCoefficient)
{
    // Edge-on, hanging vertically: the terminal velocity of skin friction.
    Flight flight;
    flight.gravity = Vec3(kGravity, 0.0, 0.0);
    const double terminal = std::sqrt(2.0 * kArealDensity * kGravity / (kDensity * kTangential));
    flight.expect_terminal_velocity(Vec3(terminal, 0.0, 0.0), 0.01, 10.0);
}

TEST(Aerodynamics, PushesWithTheDragOfAPlateForShortSteps)
{
    Flight flight;
    flight.wind = Vec3(0.0, 7.0, 0.0);
    const double exact = 0.5 * kDensity * kNormal * 49.0 / kArealDensity;
    for (const Vec3& a : flight.acceleration(1e-9))
        EXPECT_LT((a - Vec3(0.0, exact, 0.0)).norm(), 1e-6 * exact);
}

TEST(Aerodynamics, IsTheSameFromAllSidesAndFarAway)
{
    Flight flight, rotated;
    const Mat3 rotation = Eigen::AngleAxisd(1.3, Vec3(3, -1, 2).normalized()).toRotationMatrix();
    flight.wind = Vec3(3.0, -5.0, 1.0);
    rotated.wind = rotation * flight.wind;
    for (size_t i = 0; i < flight.x.size(); ++i) {
        flight.v[i] = Vec3(std::sin(double(i)), 0.3, -0.1 * double(i));
        rotated.v[i] = rotation * flight.v[i];
        rotated.x[i] = rotation * flight.x[i] + Vec3(10, 20, 30);
    }
    const std::vector<Vec3> a = flight.acceleration(0.01), b = rotated.acceleration(0.01);
    for (size_t i = 0; i < a.size(); ++i)
        EXPECT_LT((rotation * a[i] - b[i]).norm(), 1e-11 * (1.0 + a[i].norm()));
}

TEST(Aerodynamics, DoesNothingToClothThatMovesWithTheWind)
{
    Flight flight;
    flight.wind = Vec3(4.0, -2.0, 8.0);
    flight.v.assign(flight.x.size(), flight.wind);
    for (const Vec3& a : flight.acceleration(0.01))
        EXPECT_EQ(a, Vec3(0.0, 0.0, 0.0));
}

TEST(Aerodynamics, IsStableInAnyWindWithAnyFabric)
{
    // A millionth of a gram per square metre in a wind of 10 km/s: the cloth moves with the wind, no faster.
    for (const double areal_density : {1e-9, 1e-3, 1.0}) {
        Flight flight(areal_density);
        flight.wind = Vec3(0.0, 1e4, 0.0);
        for (int step = 0; step < 50; ++step) {
            const double before = flight.wind.y() - flight.v[0].y();
            flight.step(1.0 / 30.0);
            for (const Vec3& v : flight.v) {
                EXPECT_GE(v.y(), 0.0);
                EXPECT_LE(v.y(), 1e4 * (1.0 + 1e-12));
            }
            EXPECT_LE(flight.wind.y() - flight.v[0].y(), before + 1e-9);
        }
    }
}

TEST(Aerodynamics, IsInactiveWithoutAirOrCoefficients)
{
    const auto rest = make_sheet(Vec2(0.1, 0.1), 1, 1).rest();
    EXPECT_TRUE(Aerodynamics(rest, {1.2, 1.0, 0.0}).is_active());
    EXPECT_TRUE(Aerodynamics(rest, {1.2, 0.0, 0.1}).is_active());
    EXPECT_FALSE(Aerodynamics(rest, {0.0, 1.0, 0.1}).is_active());
    EXPECT_FALSE(Aerodynamics(rest, {1.2, 0.0, 0.0}).is_active());
}

} // namespace
} // namespace toile::test
