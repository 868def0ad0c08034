#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <Eigen/Geometry>

#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "tests/garment/sheets.h"

/// Angular momentum of a free sheet under implicit Euler. The elastic forces have no moment at the end of the
/// step, where they are evaluated:
///
///   sum_i m_i x_i(t1) x (v_i(t1) - v_i(t0)) = 0 exactly,
///
/// but the momentum at the start has x_i(t0), so that sum m x x v falls by dt sum m v(t0) x v(t1). A rigid
/// body that rotates by theta in one step and by theta' in the next satisfies sin(theta + theta') = 2
/// sin(theta'). Hence tan(theta') = sin(theta) / (2 - cos(theta)), and its momentum is I sin(theta) / dt.
namespace toile::test {

using namespace garment;

namespace {

constexpr double kSpin = 6.0; // [1/s]

/// Free, crumpled sheet that spins about an axis through its centre of mass.
struct SpinningSheet {
    Sheet sheet = make_sheet(Vec2(0.3, 0.3), 8, 8, Pattern::Irregular);
    std::shared_ptr<const RestShape> rest = sheet.rest();
    std::vector<double> masses = masses_of(*rest, 0.15);
    std::unique_ptr<Body> body;

    explicit SpinningSheet(double ripple)
    {
        const std::vector<std::shared_ptr<Energy>> energies{
            std::make_shared<Membrane>(rest, Membrane::Settings{300.0, 200.0, 40.0}, "sheet"),
            std::make_shared<Bending>(rest, Bending::Settings{1e-4, 1e-4}, "sheet")};
        std::vector<Vec3> x = sheet.flat(), v;
        Vec3 center = Vec3::Zero();
        double mass = 0.0;
        for (size_t i = 0; i < x.size(); ++i) {
            x[i].y() += ripple * std::sin(30.0 * x[i].x() + 7.0 * x[i].z());
            center += masses[i] * x[i];
            mass += masses[i];
        }
        for (Vec3& p : x)
            p -= center / mass;
        for (const Vec3& p : x)
            v.push_back(kSpin * Vec3(0.0, 1.0, 0.0).cross(p));
        Body::Settings settings;
        settings.tolerance = 1e-10;
        settings.max_iterations = 500;
        body = std::make_unique<Body>(x, std::make_unique<System>(masses, energies), settings);
        body->set_velocities(v);
    }
    void step(double dt)
    {
        const std::vector<Vec3> nothing(masses.size(), Vec3::Zero());
        (void)body->step(dt, nothing, std::vector<unsigned char>(masses.size(), 0), nothing, nullptr,
                         nullptr);
    }
    std::vector<Vec3> velocities() const { return {body->velocities().begin(), body->velocities().end()}; }

    /// sum_i m_i x_i x v_i at the current positions [kg m^2/s].
    Vec3 angular_momentum(const std::vector<Vec3>& v) const
    {
        Vec3 sum = Vec3::Zero();
        for (size_t i = 0; i < masses.size(); ++i)
            sum += masses[i] * body->positions()[int(i)].cross(v[i]);
        return sum;
    }
};

TEST(Body, ExertsNoMomentAtTheEndOfAStep)
{
    SpinningSheet spinning(0.01);
    for (int k = 0; k < 30; ++k) {
        const std::vector<Vec3> before = spinning.velocities();
        spinning.step(1.0 / 120.0);
        const Vec3 now = spinning.angular_momentum(spinning.velocities());
        // Up to the tolerance of the minimisation.
        EXPECT_LT((now - spinning.angular_momentum(before)).norm(), 1e-7 * now.norm()) << "step " << k;
    }
}

/// Fractions of the angular momentum lost in a quarter of a second in steps of dt [s].
struct Loss {
    double sheet, rigid_body;
};

Loss loss(double dt)
{
    SpinningSheet spinning(0.0);
    const double start = spinning.angular_momentum(spinning.velocities()).norm();
    const int steps = int(std::lround(0.25 / dt));
    double angle = std::atan(kSpin * dt);
    for (int k = 0; k < steps; ++k) {
        spinning.step(dt);
        if (k > 0)
            angle = std::atan(std::sin(angle) / (2.0 - std::cos(angle)));
    }
    return {1.0 - spinning.angular_momentum(spinning.velocities()).norm() / start,
            1.0 - std::sin(angle) / (dt * kSpin)};
}

TEST(Body, LosesAngularMomentumLikeARigidBodyUnderImplicitEuler)
{
    const Loss coarse = loss(1.0 / 60.0), fine = loss(1.0 / 120.0);
    EXPECT_NEAR(coarse.sheet, coarse.rigid_body, 0.002 * coarse.rigid_body);
    EXPECT_NEAR(fine.sheet, fine.rigid_body, 0.002 * fine.rigid_body);
    EXPECT_LT(fine.sheet, 0.6 * coarse.sheet) << "first order in the time step";
}

} // namespace
} // namespace toile::test
