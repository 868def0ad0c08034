#include "garment/energy/strain_limit/stretch_tension.h"

#include <gtest/gtest.h>

#include <cmath>

#include "garment/energy/membrane.h"
#include "garment/energy/strain_limit/strain_limit.h"
#include "tests/garment/gradient_check.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kLimit = 0.06;
constexpr double kStiffness = 250.0; // [N/m]

StretchTension tension_of(const Sheet& sheet)
{
    return StretchTension(sheet.rest(), StretchTension::Settings{kLimit, kStiffness, 1.0});
}

/// Positions stretched along u by the factor `stretch`, with waves across.
std::vector<Vec3> pulled(const Sheet& sheet, double stretch)
{
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x)
        p = Vec3(stretch * p.x(), 0.004 * std::sin(40 * p.x() + 9 * p.z()), p.z());
    return x;
}

TEST(StretchTension, HasTheGradientOfItsValueWithRememberedTension)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 5, 5, Pattern::Irregular);
    StretchTension tension = tension_of(sheet);
    tension.begin_step(pulled(sheet, 1.1));
    tension.remember(pulled(sheet, 1.1));
    const std::vector<Vec3> x = pulled(sheet, 1.08);
    tension.begin_step(x);

    ASSERT_GT(value_of(tension, x), 0.0);
    expect_gradient_of_value(tension, x);
}

TEST(StretchTension, IsZeroBelowTheLimit)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 5, 5);
    StretchTension tension = tension_of(sheet);
    const std::vector<Vec3> x = pulled(sheet, 1.03);
    tension.begin_step(x);
    EXPECT_EQ(value_of(tension, x), 0.0);
}

TEST(StretchTension, PullsByStiffnessTimesExcess)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.1), 4, 2);
    StretchTension tension = tension_of(sheet);
    std::vector<Vec3> x = sheet.flat();
    for (Vec3& p : x)
        p.x() *= 1.10;
    tension.begin_step(x);
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    tension.add_gradient(x, gradient);

    double force = 0.0; // on the right border, 0.1 m wide
    for (int row = 0; row <= sheet.rows; ++row)
        force += gradient[sheet.at(sheet.columns, row)].x();
    EXPECT_NEAR(force, kStiffness * (1.10 - (1.0 + kLimit)) * 0.1, 1e-9);
}

TEST(StretchTension, IsBoundedAndForgottenWhenTheClothSlackens)
{
    const Sheet sheet = make_sheet(Vec2(0.2, 0.2), 3, 3);
    StretchTension tension = tension_of(sheet);
    const std::vector<Vec3> far = pulled(sheet, 5.0), slack = pulled(sheet, 0.9);
    for (int k = 0; k < 100; ++k) {
        tension.begin_step(far);
        tension.remember(far);
    }
    tension.begin_step(slack);
    const double remembered = value_of(tension, slack);
    const double largest = 0.5 * kStiffness * 0.2 * 0.2; // of a tension of k on every triangle
    EXPECT_LE(remembered, largest * (1.0 + 1e-9));

    for (int k = 0; k < 10; ++k) {
        tension.begin_step(slack);
        tension.remember(slack);
    }
    tension.begin_step(slack);
    EXPECT_EQ(value_of(tension, slack), 0.0);
}

/// Max strain of a sheet after hanging from two corners for a second.
double strain_on_two_pins(bool with_tension)
{
    const Sheet sheet = make_sheet(Vec2(0.8, 0.8), 40, 40);
    const auto rest = sheet.rest();
    std::vector<std::shared_ptr<Energy>> energies{
        std::make_shared<Membrane>(rest, Membrane::Settings{kStiffness, kStiffness, 100.0}, "sheet")};
    std::shared_ptr<StretchTension> tension;
    if (with_tension) {
        tension = std::make_shared<StretchTension>(rest, StretchTension::Settings{kLimit, kStiffness, 1.0});
        energies.push_back(tension);
    }
    StrainLimit::Settings settings;
    settings.limit = kLimit;
    StrainLimit limit(rest, settings, "sheet");
    limit.set_tension(tension);
    const std::vector<Vec3> start = sheet.flat();
    Body::Settings solver;
    solver.tolerance = 1e-4;
    Body body(start, std::make_unique<System>(masses_of(*rest, 0.3), energies), solver);

    std::vector<unsigned char> fixed(start.size(), 0);
    fixed[sheet.at(0, 0)] = fixed[sheet.at(40, 0)] = 1;
    const std::vector<Vec3> gravity(start.size(), Vec3(0, -9.81, 0));
    double largest = 0.0;
    for (int step = 0; step < 120; ++step) {
        if (tension)
            tension->begin_step(body.positions());
        (void)body.step(1.0 / 120.0, gravity, fixed, start, nullptr, &limit);
        if (step > 60)
            largest = std::max(largest, limit.max_strain(body.positions()));
    }
    return largest;
}

TEST(StretchTension, KeepsTheLimitOfASheetOnTwoPinsUnlikeClampingAlone)
{
    EXPECT_GT(strain_on_two_pins(false), 3.0 * kLimit);
    EXPECT_LT(strain_on_two_pins(true), 1.7 * kLimit);
}

} // namespace
} // namespace toile::test
