#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>

#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"
#include "tests/garment/sheets.h"

namespace toile::test {

using namespace garment;

namespace {

constexpr double kGravity = 9.81;
constexpr double kArealDensity = 0.1; // [kg/m^2]
constexpr double kLength = 0.09;      // [m]

struct Reference {
    double G;                 // rho g L^3 / D
    double height_over_width; // exact heavy elastica
};
constexpr Reference kElastica[] = {{1, 0.12456}, {5, 0.58572}, {10, 1.06680}, {50, 3.70556}, {100, 5.88811}};

/// Mesh of the strip and accuracy of its equilibrium.
struct Resolution {
    int columns = 40, rows = 4;
    double tolerance = 1e-7; ///< [m] of a step
    int max_iterations = 200;
    double speed = 1e-4; ///< [m/s] below which the strip is at rest
};

/// Drop over reach of the tip of a strip clamped at one end. The clamp line runs through the middle of the
/// first cell, whose two columns are fixed: the angle is zero there to second order.
double height_over_width(Pattern pattern, double G, const Resolution& resolution)
{
    const int columns = resolution.columns, rows = resolution.rows;
    const double cell = kLength / (columns - 0.5);
    const Sheet sheet = make_sheet(Vec2(columns * cell, rows * cell), columns, rows, pattern);
    const auto rest = sheet.rest();
    const double D = kArealDensity * kGravity * std::pow(kLength, 3) / G;

    Membrane::Settings stiff;
    stiff.warp = stiff.weft = 500.0;
    stiff.shear = 250.0;
    std::vector<std::shared_ptr<Energy>> energies{
        std::make_shared<Membrane>(rest, stiff, "strip"),
        std::make_shared<Bending>(rest, Bending::Settings{D, D}, "strip")};
    Body::Settings settings;
    settings.tolerance = resolution.tolerance;
    settings.max_iterations = resolution.max_iterations;
    Body body(sheet.flat(), std::make_unique<System>(masses_of(*rest, kArealDensity), energies), settings);

    std::vector<unsigned char> fixed(sheet.uv.size(), 0);
    for (int row = 0; row <= rows; ++row)
        fixed[sheet.at(0, row)] = fixed[sheet.at(1, row)] = 1;
    EXPECT_TRUE(run_to_rest(body, 0.1, fixed, resolution.speed, 300));

    Vec3 tip = Vec3::Zero();
    for (int row = 0; row <= rows; ++row)
        tip += body.positions()[sheet.at(columns, row)] / (rows + 1.0);
    return -tip.y() / (tip.x() - 0.5 * cell);
}

class Cantilever : public testing::TestWithParam<Pattern> {};

std::string name_of(const testing::TestParamInfo<Pattern>& test)
{
    constexpr const char* kNames[] = {"Regular", "FlippedDiagonal", "Irregular"};
    return kNames[int(test.param)];
}

TEST_P(Cantilever, HangsLikeTheHeavyElastica)
{
    for (const Reference& exact : kElastica)
        EXPECT_NEAR(height_over_width(GetParam(), exact.G, {}) / exact.height_over_width, 1.0, 0.02)
            << "G = " << exact.G;
}

TEST_P(Cantilever, HalvesItsErrorWithTheCellSize)
{
    // Equal strips: the ratio of width to length is constant.
    const Reference exact = kElastica[0];
    double previous = 0.05;
    for (const int rows : {2, 4, 8}) {
        const double found = height_over_width(GetParam(), exact.G, {5 * rows, rows, 1e-9, 3000, 2e-6});
        const double error = std::abs(found / exact.height_over_width - 1.0);
        EXPECT_LT(error, 0.5 * previous) << 5 * rows << " cells along the strip";
        previous = error;
    }
}

INSTANTIATE_TEST_SUITE_P(Meshes, Cantilever,
                         testing::Values(Pattern::Regular, Pattern::FlippedDiagonal, Pattern::Irregular),
                         name_of);

} // namespace
} // namespace toile::test
