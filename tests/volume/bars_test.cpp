#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "tests/volume/blocks.h"
#include "tests/volume/statics.h"
#include "volume/energy/elastic_solid.h"

/// Bars of square section along x, against the theory of beams.
namespace toile::test {

using namespace volume;

namespace {

constexpr double kYoung = 1e6, kSide = 0.2; // [Pa], [m]

double shear_modulus(double poisson) { return kYoung / (2.0 * (1.0 + poisson)); }

struct Bar {
    Block block;
    std::shared_ptr<RestTets> rest;
    Statics statics;

    Bar(double length, int across, double poisson)
        : block(make_block({length, kSide, kSide},
                           {int(std::lround(std::max(length / kSide, 1.0))) * across, across, across})),
          rest(std::make_shared<RestTets>(rest_tets(block.mesh, "bar"))),
          statics(std::make_shared<ElasticSolid>(
                      rest, std::vector<Lame>(block.mesh.tets.size(),
                                              ElasticMaterial{kYoung, poisson}.lame("bar"))),
                  block.mesh.positions)
    {
    }

    /// Vertices at the end x = 0 or x = length.
    std::vector<int> end(bool far) const
    {
        std::vector<int> vertices;
        for (int k = 0; k <= block.cells[2]; ++k)
            for (int j = 0; j <= block.cells[1]; ++j)
                vertices.push_back(block.at(far ? block.cells[0] : 0, j, k));
        return vertices;
    }
};

/// Deflection of the free end of a bar under its weight, relative to Timoshenko's beam with Cowper's shear
/// coefficient [Cowper 1966].
double relative_deflection(int across, double poisson)
{
    constexpr double kLength = 5.0 * kSide, kWeight = 10.0; // [m], [N/m^3]
    Bar bar(kLength, across, poisson);
    for (const int v : bar.end(false))
        for (int axis = 0; axis < 3; ++axis)
            bar.statics.prescribe(v, axis, 0.0);
    const std::vector<double> volumes = bar.rest->vertex_volumes();
    for (int v = 0; v < int(volumes.size()); ++v)
        bar.statics.add_force(v, Vec3(0.0, -kWeight * volumes[v], 0.0));
    const Statics::Solution solution = bar.statics.solve();
    double deflection = 0.0;
    for (const int v : bar.end(true))
        deflection -= solution.displacements[v].y() / double(bar.end(true).size());

    const double area = kSide * kSide, load = kWeight * area,
                 shear = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson);
    const double exact = load * std::pow(kLength, 4) / (8.0 * kYoung * area * area / 12.0) +
                         load * kLength * kLength / (2.0 * shear * shear_modulus(poisson) * area);
    return deflection / exact;
}

/// Torque of a twisted bar whose ends may warp, relative to Saint-Venant's.
double relative_torque(int across, double poisson)
{
    constexpr double kLength = 0.5 * kSide, kAngle = 1e-3; // [m], [rad]
    Bar bar(kLength, across, poisson);
    const Vec3 axis(0.0, 0.5 * kSide, 0.5 * kSide);
    for (const bool far : {false, true})
        for (const int v : bar.end(far)) {
            const Vec3 arm = bar.block.mesh.positions[v] - axis;
            bar.statics.prescribe(v, 1, far ? -kAngle * arm.z() : 0.0);
            bar.statics.prescribe(v, 2, far ? kAngle * arm.y() : 0.0);
        }
    bar.statics.prescribe(0, 0, 0.0);
    const Statics::Solution solution = bar.statics.solve();
    double torque = 0.0;
    for (const int v : bar.end(true))
        torque += (bar.block.mesh.positions[v] - axis).cross(solution.reactions[v]).x();
    constexpr double kSquare = 0.140577; // torsion constant over side^4 [Timoshenko & Goodier 1970, sec. 109]
    return torque / (shear_modulus(poisson) * kSquare * std::pow(kSide, 4) * kAngle / kLength);
}

/// Moment of a bar that is bent to a circle, relative to the exact one: sections stay flat, and contract as
/// they like [Timoshenko & Goodier 1970, sec. 102].
double relative_moment(int across, double poisson)
{
    constexpr double kLength = kSide, kCurvature = 1e-3; // [m], [1/m]
    Bar bar(kLength, across, poisson);
    for (const bool far : {false, true})
        for (const int v : bar.end(far)) {
            const double height = bar.block.mesh.positions[v].y() - 0.5 * kSide;
            bar.statics.prescribe(v, 0, far ? -kCurvature * kLength * height : 0.0);
        }
    const int corner = bar.block.at(0, 0, 0), next = bar.block.at(0, 0, bar.block.cells[2]);
    bar.statics.prescribe(corner, 1, 0.0);
    bar.statics.prescribe(corner, 2, 0.0);
    bar.statics.prescribe(next, 1, 0.0);
    const Statics::Solution solution = bar.statics.solve();
    double moment = 0.0;
    for (const int v : bar.end(true))
        moment -= (bar.block.mesh.positions[v].y() - 0.5 * kSide) * solution.reactions[v].x();
    return moment / (kYoung * std::pow(kSide, 4) / 12.0 * kCurvature);
}

/// Bars of 4, 8 and 16 tetrahedra across: the errors fall as h^2, and the last is within 2 %.
template <typename Relative>
void expect_second_order(const Relative& relative, double poisson)
{
    const std::array<double, 3> found{relative(4, poisson), relative(8, poisson), relative(16, poisson)};
    EXPECT_NEAR(found[2], 1.0, 0.02);
    const double fall = (found[1] - found[0]) / (found[2] - found[1]);
    EXPECT_GT(fall, 3.0);
    EXPECT_LT(fall, 5.0);
}

TEST(Bars, CantileverHasAnErrorOfSecondOrder) { expect_second_order(relative_deflection, 0.0); }

TEST(Bars, BendingHasAnErrorOfSecondOrder)
{
    for (const double poisson : {0.0, 0.3, 0.45})
        expect_second_order(relative_moment, poisson);
}

TEST(Bars, TorsionHasAnErrorOfSecondOrder)
{
    for (const double poisson : {0.0, 0.3, 0.45})
        expect_second_order(relative_torque, poisson);
}

} // namespace
} // namespace toile::test
