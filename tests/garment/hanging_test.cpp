#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "garment/energy/membrane.h"
#include "tests/garment/sheets.h"

/// Hanging cloth compared with exact solutions of statics.
namespace toile::test {

using namespace garment;

namespace {

constexpr double kGravity = 9.81;
constexpr double kArealDensity = 0.2;     // [kg/m^2]
constexpr double kStretch = 1.0 / 3000.0; // [-] of the catenary strip under its own weight

std::unique_ptr<Body> make_body(const Sheet& sheet, std::vector<Vec3> x, const Membrane::Settings& stretch,
                                int max_iterations)
{
    const auto rest = sheet.rest();
    const std::vector<std::shared_ptr<Energy>> energies{std::make_shared<Membrane>(rest, stretch, "strip")};
    Body::Settings settings;
    settings.tolerance = 1e-8;
    settings.max_iterations = max_iterations;
    return std::make_unique<Body>(
        std::move(x), std::make_unique<System>(masses_of(*rest, kArealDensity), energies), settings);
}

/// Mean extension of the lower end of a strip of length 1 m whose warp hangs vertically from its upper end.
double extension(Pattern pattern, int columns, double Y)
{
    const Sheet sheet = make_sheet(Vec2(1.0, 4.0 / columns), columns, 4, pattern);
    std::vector<Vec3> x;
    std::vector<unsigned char> fixed(sheet.uv.size(), 0);
    for (const Vec2& p : sheet.uv)
        x.emplace_back(p.y(), -p.x(), 0.0);
    for (int row = 0; row <= 4; ++row)
        fixed[sheet.at(0, row)] = 1;
    const auto body = make_body(sheet, x, {Y, 0.8 * Y, 0.3 * Y}, 200);
    EXPECT_TRUE(run_to_rest(*body, 0.1, fixed, 1e-7, 400));
    double sum = 0.0;
    for (int row = 0; row <= 4; ++row)
        sum += -body->positions()[sheet.at(columns, row)].y() - 1.0;
    return sum / 5.0;
}

TEST(HangingStrip, StretchesByItsWeight)
{
    // rho_A g L^2 / (2 Y): 0.5 % and 10 % of the length. Poisson's ratio is zero and stress is linear in
    // stretch, so the solution holds at both. Twenty cells with lumped weights deviate by 4e-5 at most.
    for (const double strain : {0.005, 0.1}) {
        const double Y = kArealDensity * kGravity / (2.0 * strain);
        for (const Pattern pattern : {Pattern::Regular, Pattern::FlippedDiagonal, Pattern::Irregular}) {
            const double found = extension(pattern, 20, Y);
            EXPECT_NEAR(found / strain, 1.0, 2e-4) << "strain " << strain;
        }
    }
}

/// Inextensible strip of length L between two bars at the same height, d apart. With L = 2 a sinh(d / 2a),
/// sag = a (cosh(d / 2a) - 1), and the pull at an end is rho_A g a cosh(d / 2a) per width.
struct Catenary {
    double distance; ///< d / L
    double sag;      ///< over L
    double tension;  ///< pull at an end over the whole weight
};
constexpr Catenary kCatenaries[] = {
    {0.5, 0.39819, 0.51301}, {0.7, 0.31972, 0.55083}, {0.9, 0.19071, 0.75080}, {0.95, 0.13590, 0.98776}};

/// Half the angle of the circular arc of length 1 over a chord.
double half_angle(double chord)
{
    double low = 1e-3, high = std::numbers::pi;
    for (int k = 0; k < 60; ++k) {
        const double angle = 0.5 * (low + high);
        (std::sin(angle) / angle > chord ? low : high) = angle;
    }
    return low;
}

/// Hangs a strip of length 1 m between two bars, from the start shape of a circular arc.
Catenary hang(double distance, int columns)
{
    const Sheet sheet = make_sheet(Vec2(1.0, 1.0 / columns), columns, 1);
    const double half = half_angle(distance), radius = 0.5 / half;
    std::vector<Vec3> x;
    for (const Vec2& p : sheet.uv) {
        const double angle = (2.0 * p.x() - 1.0) * half;
        x.emplace_back(radius * std::sin(angle), radius * (std::cos(half) - std::cos(angle)), p.y());
    }
    std::vector<unsigned char> fixed(sheet.uv.size(), 0);
    for (int row = 0; row <= 1; ++row)
        fixed[sheet.at(0, row)] = fixed[sheet.at(columns, row)] = 1;
    const double Y = kArealDensity * kGravity / kStretch;
    const auto body = make_body(sheet, x, {Y, Y, 0.5 * Y}, 2000);
    EXPECT_TRUE(run_to_rest(*body, 0.05, fixed, 1e-3, 60));

    // The pull of one end is the force on its fixed vertices, their own weight included.
    const View<const Vec3> at_rest = body->positions();
    const View<const double> masses = body->system().masses();
    std::vector<Vec3> gradient(x.size(), Vec3::Zero());
    body->system().add_gradient(at_rest, gradient);
    Vec3 pull = Vec3::Zero();
    for (const int v : {sheet.at(0, 0), sheet.at(0, 1)})
        pull += gradient[v] + masses[v] * Vec3(0.0, kGravity, 0.0);
    double lowest = 0.0, weight = 0.0;
    for (int v = 0; v < at_rest.size(); ++v) {
        lowest = std::min(lowest, at_rest[v].y());
        weight += masses[v] * kGravity;
    }
    return {distance, -lowest, pull.norm() / weight};
}

TEST(HangingStrip, IsACatenaryBetweenTwoBars)
{
    // The rest is stretch: the strip is kStretch longer per unit of its tension over its weight. At 0.95 this
    // deepens the sag by about kStretch / 2 / (1 - 0.95) = 0.3 %, plus the polygon of 40 cells.
    for (const Catenary& exact : kCatenaries) {
        const Catenary found = hang(exact.distance, 40);
        EXPECT_NEAR(found.sag / exact.sag, 1.0, 0.005) << "d / L = " << exact.distance;
        EXPECT_NEAR(found.tension / exact.tension, 1.0, 0.005) << "d / L = " << exact.distance;
    }
}

} // namespace
} // namespace toile::test
