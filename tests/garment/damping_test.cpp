#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "garment/energy/bend_damping.h"
#include "garment/energy/membrane.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/sheets.h"

/// Internal friction: a potential of the change of shape during a step.
namespace toile::test {

using namespace garment;

namespace {

constexpr double kDt = 1.0 / 120.0;

/// Sheet rolled about the z axis with a radius [m], stretched along x and z.
std::vector<Vec3> rolled(const Sheet& sheet, double radius, double warp = 1.0, double weft = 1.0)
{
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x) {
        const double angle = warp * p.x() / radius;
        p = Vec3(radius * std::sin(angle), radius * (1.0 - std::cos(angle)), weft * p.z());
    }
    return x;
}

std::vector<Vec3> moved(std::vector<Vec3> x)
{
    const Mat3 R = Eigen::AngleAxisd(2.0, Vec3(1, -2, 3).normalized()).toRotationMatrix();
    for (Vec3& p : x)
        p = R * p + Vec3(0.3, 1.0, -2.0);
    return x;
}

void expect_no_sum_and_no_torque(Energy& energy, const std::vector<Vec3>& x)
{
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    energy.add_gradient(x, gradient);
    Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
    double size = 0.0;
    for (size_t i = 0; i < x.size(); ++i) {
        sum += gradient[i];
        torque += x[i].cross(gradient[i]);
        size += gradient[i].norm();
    }
    ASSERT_GT(size, 0.0);
    EXPECT_LT(sum.norm(), 1e-12 * size);
    EXPECT_LT(torque.norm(), 1e-12 * size);
}

const Sheet& sheet()
{
    static const Sheet sheet = make_sheet(Vec2(0.2, 0.15), 7, 5, Pattern::Irregular);
    return sheet;
}

/// Folds and the yarns' friction alone, or viscosity alone.
std::shared_ptr<BendDamping> bend_damping(double time, double friction)
{
    return std::make_shared<BendDamping>(*sheet().rest(), BendDamping::Settings{{3e-6, 2e-6}, time, friction},
                                         "sheet");
}

/// Difference of the value to that of the same membrane without viscosity, so of the viscosity alone.
class Viscosity : public Energy {
public:
    Viscosity()
        : viscous_(sheet().rest(), Membrane::Settings{300.0, 200.0, 40.0, 0.001, 0.003}, "sheet"),
          elastic_(sheet().rest(), Membrane::Settings{300.0, 200.0, 40.0}, "sheet")
    {
    }
    void begin_step(View<const Vec3> x, double dt) { viscous_.begin_step(x, dt); }
    std::string_view name() const override { return "viscosity"; }
    void add_hessian(Triplets&) const override {}
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override
    {
        std::vector<Vec3> elastic(x.size(), Vec3::Zero());
        const double without = elastic_.add_gradient(x, elastic);
        const double with = viscous_.add_gradient(x, gradient);
        for (int i = 0; i < x.size(); ++i)
            gradient[i] -= elastic[i];
        return with - without;
    }

private:
    Membrane viscous_, elastic_;
};

TEST(Viscosity, IsZeroWithoutAStepAndForRigidMotion)
{
    Viscosity viscosity;
    const std::vector<Vec3> start = rolled(sheet(), 0.1, 1.02, 0.97);
    EXPECT_EQ(value_of(viscosity, rolled(sheet(), 0.1)), 0.0);
    viscosity.begin_step(start, kDt);
    EXPECT_LT(value_of(viscosity, moved(start)), 1e-18);
    EXPECT_GT(value_of(viscosity, rolled(sheet(), 0.1)), 1e-6);
}

TEST(Viscosity, CostsTimesTheModuliPerStep)
{
    // A uniform stretch by e along the warp of a flat sheet: dE_uu = e + e^2 / 2.
    Viscosity viscosity;
    viscosity.begin_step(sheet().flat(), kDt);
    std::vector<Vec3> x = sheet().flat();
    for (Vec3& p : x)
        p.x() *= 1.01;
    const double strain = 0.01 + 0.5 * 0.01 * 0.01;
    EXPECT_NEAR(value_of(viscosity, x), 0.5 * 0.03 * 300.0 * 0.001 / kDt * strain * strain, 1e-12);
}

TEST(Viscosity, HasTheGradientOfItsValueAndMovesNoMomentum)
{
    Viscosity viscosity;
    viscosity.begin_step(rolled(sheet(), 0.1, 1.02, 0.97), kDt);
    expect_gradient_of_value(viscosity, rolled(sheet(), 0.12, 0.95, 1.03));
    expect_no_sum_and_no_torque(viscosity, moved(rolled(sheet(), 0.12, 0.95, 1.03)));
}

TEST(BendDamping, IsZeroWithoutAStepAndForRigidMotion)
{
    const auto damping = bend_damping(0.03, 12.0);
    const std::vector<Vec3> start = rolled(sheet(), 0.1);
    EXPECT_EQ(value_of(*damping, rolled(sheet(), 0.05)), 0.0);
    damping->begin_step(start, kDt);
    EXPECT_LT(value_of(*damping, moved(start)), 1e-18);
    EXPECT_GT(value_of(*damping, rolled(sheet(), 0.05)), 1e-7);
}

TEST(BendDamping, HasTheGradientOfItsValueAndMovesNoMomentum)
{
    // Folds of less than a right angle, of more, and back through flat.
    for (const double radius : {0.05, 0.012, -0.05}) {
        const auto damping = bend_damping(0.03, 12.0);
        damping->begin_step(rolled(sheet(), 0.02), kDt);
        expect_gradient_of_value(*damping, rolled(sheet(), radius));
        expect_no_sum_and_no_torque(*damping, moved(rolled(sheet(), radius)));
    }
}

TEST(BendDamping, DissipatesByTheCurvatureThatFrictionHolds)
{
    // Rolling a regular sheet to a curvature k against the moment m per width costs m k per area. Each column
    // of hinges across the roll turns by its spacing times k.
    const Sheet regular = make_sheet(Vec2(0.3, 0.1), 30, 1);
    const double rigidity = 3e-6, friction = 12.0, radius = 0.1;
    BendDamping damping(*regular.rest(), BendDamping::Settings{{rigidity, rigidity}, 0.0, friction}, "sheet");
    damping.begin_step(regular.flat(), kDt);
    const double expected = friction * rigidity / radius * 0.3 * 0.1;
    EXPECT_NEAR(value_of(damping, rolled(regular, radius)), expected, 0.05 * expected);
}

TEST(BendDamping, IsFiniteWhereTrianglesHaveCollapsed)
{
    const auto damping = bend_damping(0.03, 12.0);
    damping->begin_step(sheet().flat(), kDt);
    const std::vector<Vec3> point(sheet().uv.size(), Vec3(1, 2, 3));
    std::vector<Vec3> gradient(point.size(), Vec3::Zero());
    EXPECT_TRUE(std::isfinite(damping->add_gradient(point, gradient)));
    for (const Vec3& g : gradient)
        EXPECT_TRUE(g.allFinite());
}

TEST(BendDamping, RefusesNegativeTimes)
{
    EXPECT_THROW(bend_damping(-0.1, 0.0), InvalidInput);
    EXPECT_THROW(bend_damping(0.1, std::nan("")), InvalidInput);
}

} // namespace
} // namespace toile::test
