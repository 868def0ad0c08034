#include <cmath>
#include <memory>

#include "core/base/error.h"
#include "research/methods/vbd/cuda/vertex_block_descent.h"
#include "research/methods/vbd/vertex_block_descent.h"
#include "research/methods/xpbd/cuda/xpbd.h"
#include "research/methods/xpbd/xpbd.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/garment/sheets.h"

/// Baseline methods on a GPU compared with the CPU.
namespace toile::test {

using namespace research;

namespace {

constexpr double kDt = 1.0 / 120.0;

/// Sheet that swings from two corners, one of which moves.
struct Swing {
    Sheet sheet;
    ClothModel cloth;
    std::vector<Vec3> x = sheet.flat(), v, acceleration, targets;
    std::vector<unsigned char> fixed;

    explicit Swing(const Sheet& shape = make_sheet(Vec2(0.6, 0.4), 30, 20, Pattern::Irregular)) : sheet(shape)
    {
        cloth.rest = sheet.rest();
        cloth.masses = masses_of(*cloth.rest, 0.2);
        cloth.stretch = {300.0, 120.0, 20.0};
        cloth.bending = {5e-6, 2e-6};
        acceleration.assign(x.size(), Vec3(0.0, -9.81, 0.4));
        fixed.assign(x.size(), 0);
        fixed[sheet.at(0, 0)] = fixed[sheet.at(sheet.columns, 0)] = 1;
        targets = x;
        for (const Vec3& p : x)
            v.push_back(0.3 * Vec3(std::sin(20.0 * p.z()), std::cos(15.0 * p.x()), std::cos(18.0 * p.x())));
    }
};

std::vector<Vec3> copy_of(View<const Vec3> field) { return {field.begin(), field.end()}; }

/// Positions after some steps; the moving corner advances 1 mm a step.
std::vector<Vec3> run(Swing swing, PointMasses& masses, int steps)
{
    masses.set_positions(swing.x);
    masses.set_velocities(swing.v);
    for (int k = 0; k < steps; ++k) {
        swing.targets[swing.sheet.at(swing.sheet.columns, 0)].x() += 1e-3;
        const StepReport report =
            masses.step(kDt, swing.acceleration, swing.fixed, swing.targets, nullptr, nullptr);
        EXPECT_EQ(report.status, StepReport::Status::IterationLimit) << k;
    }
    return copy_of(masses.positions());
}

double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        if (const double apart = (a[i] - b[i]).norm(); !(apart <= max)) // true for NaN too
            max = apart;
    return max;
}

class DeviceBaselineMethodTest : public OnDevice {
protected:
    template <typename Kind>
    std::unique_ptr<Kind> make(const Swing& swing, const typename Kind::Settings& settings) const
    {
        return std::make_unique<Kind>(space(), swing.x, swing.cloth, settings);
    }
};

TEST_F(DeviceBaselineMethodTest, XpbdMovesAsOnTheCpu)
{
    const Swing swing;
    for (const bool by_forces : {true, false}) {
        Xpbd here(swing.x, swing.cloth, {20, by_forces});
        const std::vector<Vec3> expected = run(swing, here, 5);
        const auto exact = make<DeviceXpbd<double>>(swing, {20, by_forces});
        EXPECT_LT(max_distance(run(swing, *exact, 5), expected), 1e-8) << by_forces;
        EXPECT_LT(max_distance(copy_of(exact->velocities()), copy_of(here.velocities())), 1e-5);
        const auto single = make<DeviceXpbd<float>>(swing, {20, by_forces});
        EXPECT_LT(max_distance(run(swing, *single, 5), expected), 2e-5) << by_forces;
    }
}

TEST_F(DeviceBaselineMethodTest, VertexBlockDescentMovesAsOnTheCpu)
{
    const Swing swing;
    for (const double rho : {0.0, 0.95}) {
        VertexBlockDescent here(swing.x, swing.cloth, {40, 0.0, rho});
        const std::vector<Vec3> expected = run(swing, here, 5);
        const auto exact = make<DeviceVertexBlockDescent<double>>(swing, {40, rho});
        EXPECT_EQ(exact->colour_count(), here.colour_count());
        EXPECT_LT(max_distance(run(swing, *exact, 5), expected), 1e-8) << rho;
        EXPECT_LT(max_distance(copy_of(exact->velocities()), copy_of(here.velocities())), 1e-5);
        // Its moment-free borders are soft: single precision shows there.
        const auto single = make<DeviceVertexBlockDescent<float>>(swing, {40, rho});
        EXPECT_LT(max_distance(run(swing, *single, 5), expected), 1e-4) << rho;
    }
}

TEST_F(DeviceBaselineMethodTest, VertexBlockDescentWithLaggedBendingFindsTheSameMinimiser)
{
    // Small: a sweep propagates a change by one edge.
    const Swing swing(make_sheet(Vec2(0.3, 0.25), 12, 10, Pattern::Irregular));
    VertexBlockDescent here(swing.x, swing.cloth, {3000, 0.0, 0.0});
    const auto lagging = make<DeviceVertexBlockDescent<double>>(swing, {3000, 0.0, true, true});
    EXPECT_LT(lagging->colour_count(), here.colour_count() / 2);
    EXPECT_LT(max_distance(run(swing, *lagging, 1), run(swing, here, 1)), 1e-6);
}

TEST_F(DeviceBaselineMethodTest, GivesTheSameBitsTwice)
{
    const Swing swing;
    const auto descent = make<DeviceVertexBlockDescent<float>>(swing, {30, 0.9});
    const auto descent_again = make<DeviceVertexBlockDescent<float>>(swing, {30, 0.9});
    EXPECT_EQ(run(swing, *descent, 4), run(swing, *descent_again, 4));
    const auto xpbd = make<DeviceXpbd<float>>(swing, {15});
    const auto xpbd_again = make<DeviceXpbd<float>>(swing, {15});
    EXPECT_EQ(run(swing, *xpbd, 4), run(swing, *xpbd_again, 4));
}

TEST_F(DeviceBaselineMethodTest, AllocatesNothingOnceRecorded)
{
    const Swing swing;
    const auto xpbd = make<DeviceXpbd<float>>(swing, {15});
    run(swing, *xpbd, 1);
    EXPECT_EQ(allocations_of([&] { run(swing, *xpbd, 3); }), 0);
}

TEST_F(DeviceBaselineMethodTest, DetectsNonFinitePositions)
{
    Swing swing;
    swing.v[7].x() = NAN;
    const auto xpbd = make<DeviceXpbd<float>>(swing, {5});
    xpbd->set_velocities(swing.v);
    EXPECT_EQ(xpbd->step(kDt, swing.acceleration, swing.fixed, swing.targets).status,
              StepReport::Status::NonFinite);
}

TEST_F(DeviceBaselineMethodTest, RefusesLessThanOneSubstep)
{
    const Swing swing;
    EXPECT_THROW(make<DeviceXpbd<float>>(swing, {0}), InvalidInput);
}

} // namespace
} // namespace toile::test
