#include "apps/toile/maps/vertex_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "core/base/error.h"
#include "garment/energy/membrane.h"
#include "garment/energy/strain_limit/stretch_tension.h"
#include "tests/apps/fit/tubes.h"

namespace toile::test {

using namespace app;

namespace {

/// Sheet of 1 m in squares, rotated in space, stretched along the panel's x (weft) and y (warp).
FittedGarment sheet(const std::string& fabric, const Vec2& stretch)
{
    constexpr int kCells = 4;
    const Eigen::Matrix3d Q = Eigen::AngleAxisd(0.7, Vec3(1.0, -1.0, 2.0).normalized()).toRotationMatrix();
    std::vector<Vec2> uv;
    FittedGarment garment;
    garment.name = "sheet";
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i) {
            uv.emplace_back(double(i) / kCells, double(j) / kCells);
            garment.mesh.positions.push_back(
                Q * Vec3(stretch.x() * uv.back().x(), stretch.y() * uv.back().y(), 0.0));
        }
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
            const int a = j * (kCells + 1) + i, b = a + kCells + 1;
            garment.mesh.triangles.emplace_back(a, a + 1, b + 1);
            garment.mesh.triangles.emplace_back(a, b + 1, b);
        }
    for (const Triangle& t : garment.mesh.triangles)
        garment.rest.push_back({uv[size_t(t[0])], uv[size_t(t[1])], uv[size_t(t[2])]});
    garment.fabrics = {garment::fabric_preset(fabric, "test")};
    garment.fabric_of_triangle.assign(garment.mesh.triangles.size(), 0);
    return garment;
}

void expect_everywhere(const std::vector<double>& values, double expected)
{
    for (const double value : values)
        EXPECT_NEAR(value, expected, 1e-11 * std::max(1.0, std::abs(expected)));
}

/// Jersey: 60 N/m along the warp, 40 along the weft, up to 25 %; beyond, 50 times the larger more.
TEST(TensionMap, OfAStretchedSheetIsItsStiffnessTimesItsStrain)
{
    expect_everywhere(tension_map(sheet("jersey", {1.0, 1.1})).values, 60.0 * 0.1);
    expect_everywhere(tension_map(sheet("jersey", {1.1, 1.0})).values, 40.0 * 0.1);
    expect_everywhere(tension_map(sheet("jersey", {1.1, 1.1})).values, 60.0 * 0.1);
    expect_everywhere(tension_map(sheet("jersey", {1.0, 1.27})).values, 60.0 * 0.27 + 50.0 * 60.0 * 0.02);
}

/// Poisson's ratio is 0, and what is compressed across does not pull less along.
TEST(TensionMap, IsNotNegativeAndDoesNotDependOnTheWidth)
{
    expect_everywhere(tension_map(sheet("jersey", {1.0, 1.0})).values, 0.0);
    expect_everywhere(tension_map(sheet("jersey", {0.9, 0.95})).values, 0.0);
    expect_everywhere(tension_map(sheet("jersey", {0.9, 1.1})).values, 60.0 * 0.1);
}

/// Force on the edge at the end of the warp, of the energies that the solver minimises [N].
double pull_on_the_edge(const FittedGarment& garment)
{
    const garment::Fabric& fabric = garment.fabrics.front();
    const auto rest = std::make_shared<const garment::RestShape>(
        garment::rest_shape_of_panels(garment.mesh, garment.rest, 0.0, garment.name));
    garment::Membrane membrane(rest, {fabric.stretch_warp, fabric.stretch_weft, fabric.shear}, "test");
    garment::StretchTension limit(
        rest, garment::StretchTension::Settings::elastic(
                  fabric.strain_limit, std::max(fabric.stretch_warp, fabric.stretch_weft), 1.0));
    std::vector<Vec3> gradient(garment.mesh.positions.size(), Vec3::Zero());
    limit.begin_step(garment.mesh.positions);
    limit.add_gradient(garment.mesh.positions, gradient);
    membrane.add_gradient(garment.mesh.positions, gradient);
    return std::accumulate(gradient.end() - 5, gradient.end(), Vec3(Vec3::Zero())).norm();
}

/// The edge is 1 m wide.
TEST(TensionMap, BalancesTheForcesOfTheSolver)
{
    for (const garment::Fabric& fabric : garment::fabric_presets())
        for (const double of_limit : {0.3, 0.9, 1.2}) {
            const FittedGarment garment = sheet(fabric.name, {1.0, 1.0 + of_limit * fabric.strain_limit});
            const double force = pull_on_the_edge(garment);
            EXPECT_GT(force, 0.0);
            expect_everywhere(tension_map(garment).values, force);
        }
}

TEST(TensionMap, HasTheFabricOfEachTriangle)
{
    FittedGarment garment = sheet("jersey", {1.0, 1.1});
    garment.fabrics.push_back(garment::fabric_preset("wool_lycra", "test"));
    std::fill(garment.fabric_of_triangle.begin(), garment.fabric_of_triangle.end(), 1);
    expect_everywhere(tension_map(garment).values, 24.9 * 0.1);
}

TEST(TensionMap, HasThePaintedStiffnessOfEachTriangle)
{
    FittedGarment garment = sheet("jersey", {1.0, 1.1});
    garment.stiffness.assign(garment.mesh.triangles.size(), 3.0);
    expect_everywhere(tension_map(garment).values, 3.0 * 60.0 * 0.1);
    garment = sheet("jersey", {1.0, 1.27});
    garment.stiffness.assign(garment.mesh.triangles.size(), 3.0);
    expect_everywhere(tension_map(garment).values, 3.0 * (60.0 * 0.27 + 50.0 * 60.0 * 0.02));
}

TEST(StrainMap, OfAStretchedSheetIsItsStretchLessOne)
{
    const VertexMap map = strain_map(sheet("cotton", {0.97, 1.042}));
    expect_everywhere(map.values, 0.042);
    EXPECT_EQ(map.scale.low, 0.0);
    EXPECT_DOUBLE_EQ(map.scale.high, 0.05) << "the next round number";
}

TEST(GapMap, OfATubeAroundACylinderIsTheDifferenceOfTheirRadii)
{
    FittedGarment garment;
    garment.mesh = tube(0.2);
    expect_everywhere(gap_map(garment, tube(0.15)).values, 0.05);
    const VertexMap inside = gap_map(garment, tube(0.21));
    for (const double value : inside.values) {
        EXPECT_LT(value, 0.0) << "inside of the body";
        EXPECT_GE(value, -0.01 - 1e-12);
        EXPECT_LE(value, 0.2 - 0.21 * std::cos(std::numbers::pi / kSides) + 1e-12);
    }
}

/// Laplace: tension over radius; cotton has 261.1 N/m, and cloth of 1 m at rest is 1.03 m long.
TEST(PressureMap, OfAStretchedTubeIsItsTensionOverItsRadius)
{
    FittedGarment garment;
    garment.name = "tube";
    garment.mesh = tube(0.2);
    garment.rest = flat(garment.mesh, 1.03);
    garment.fabrics = {garment::fabric_preset("cotton", "test")};
    garment.fabric_of_triangle.assign(garment.mesh.triangles.size(), 0);
    const double tension = 261.1 * 0.03, radius = 0.2, length = 1.03;
    const std::vector<double> on_skin = pressure_map(garment, tube(0.199)).values;
    for (int ring = 2; ring <= kRings - 2; ++ring) // the ends are pulled along the tube too
        for (int i = 0; i < kSides; ++i)
            EXPECT_NEAR(on_skin[size_t(ring * kSides + i)], tension / (radius * length),
                        0.02 * tension / (radius * length));
    expect_everywhere(pressure_map(garment, tube(0.19)).values, 0.0);
    garment.rest = flat(garment.mesh);
    expect_everywhere(pressure_map(garment, tube(0.199)).values, 0.0);
}

TEST(FittedGarment, HasTheFabricsOfItsPanels)
{
    scenes::GarmentSurface surface;
    surface.mesh = faces_of(tube(0.2));
    begin_group(surface.mesh, "front", 0);
    begin_group(surface.mesh, "back", 7);
    garment::Pattern pattern;
    pattern.panels.resize(2);
    pattern.panels[0].name = "front";
    pattern.panels[1].name = "back";
    pattern.panels[1].fabric = "denim";
    const FittedGarment garment = fitted_garment("tube", surface, pattern, "silk");
    ASSERT_EQ(garment.fabrics.size(), 2u);
    ASSERT_EQ(garment.fabric_of_triangle.size(), surface.mesh.polygons.size());
    EXPECT_EQ(garment.fabrics[size_t(garment.fabric_of_triangle[6])].name, "silk");
    EXPECT_EQ(garment.fabrics[size_t(garment.fabric_of_triangle[7])].name, "denim");
    EXPECT_THROW(fitted_garment("tube", surface, pattern, "slik"), InvalidInput);
}

/// Warp along the vertical, as rest shapes of surfaces have it: jersey is stiffer that way.
TEST(FittedGarment, OfASceneHasTheGrainOfItsRestShape)
{
    const TriangleMesh mesh = tube(0.2);
    scenes::LoadedCloth cloth;
    cloth.state.name = "tube";
    cloth.state.triangles = mesh.triangles;
    cloth.state.fabric = garment::fabric_preset("jersey", "test");
    cloth.rest = std::make_shared<const garment::RestShape>(
        garment::rest_shape_of_surface(mesh, Vec3::UnitY(), 0.0, "tube"));
    std::vector<Vec3> longer = mesh.positions, wider = mesh.positions;
    for (Vec3& x : longer)
        x.y() *= 1.1;
    for (Vec3& x : wider)
        x = Vec3(1.1 * x.x(), x.y(), 1.1 * x.z());
    const FittedGarment garment = fitted_garment(cloth, longer);
    EXPECT_EQ(garment.name, "tube");
    expect_everywhere(tension_map(garment).values, 60.0 * 0.1);
    expect_everywhere(tension_map(fitted_garment(cloth, wider)).values, 40.0 * 0.1);
    expect_everywhere(strain_map(fitted_garment(cloth, mesh.positions)).values, 0.0);
}

TEST(Quantile, IsTheValueBelowWhichAFractionLies)
{
    EXPECT_EQ(quantile({}, 0.5), 0.0);
    EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
    EXPECT_EQ(quantile({3.0, 1.0, 2.0}, 1.0), 3.0);
}

} // namespace
} // namespace toile::test
