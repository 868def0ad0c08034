#include "apps/toile/drape/garment_measures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace toile::test {

using namespace app;

namespace {

/// Squares of 1 m in a row, each a panel ("0", "1", ...) of two triangles, stretched along u.
/// @param stretches  [panels] along u [-]
ObjMesh squares(const std::vector<double>& stretches)
{
    ObjMesh mesh;
    for (size_t p = 0; p < stretches.size(); ++p) {
        const int first = int(mesh.positions.size());
        begin_group(mesh, std::to_string(p), int(mesh.polygons.size()));
        for (const Vec2& uv : {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)}) {
            mesh.texture_coordinates.push_back(uv);
            mesh.positions.push_back(Vec3(0.3, stretches[p] * uv.x(), uv.y() + 2.0 * double(p)));
        }
        mesh.polygons.push_back({first, first + 1, first + 2});
        mesh.polygons.push_back({first, first + 2, first + 3});
    }
    mesh.polygon_uvs = mesh.polygons;
    return mesh;
}

/// @param fabrics  [panels]
garment::Pattern pattern_of(const std::vector<std::string>& fabrics)
{
    garment::Pattern pattern;
    for (const std::string& fabric : fabrics) {
        garment::Panel panel;
        panel.name = std::to_string(pattern.panels.size());
        panel.fabric = fabric;
        pattern.panels.push_back(panel);
    }
    return pattern;
}

TEST(GarmentMeasures, TellStrainByFabric)
{
    const GarmentMeasures measures =
        measure_garment({squares({1.1, 1.0, 1.3}), {}}, pattern_of({"silk", "", "silk"}), "wool");
    ASSERT_EQ(measures.strains.size(), 2u);
    const FabricStrain& silk = measures.strains[0];
    EXPECT_EQ(silk.fabric, "silk");
    EXPECT_NEAR(silk.max, 0.3, 1e-14);
    EXPECT_EQ(silk.max_panel, "2");
    EXPECT_NEAR(silk.max_point.z(), 4.5, 0.25);
    EXPECT_NEAR(silk.mean, 0.2, 1e-14);
    EXPECT_NEAR(silk.p99, 0.3, 1e-14);
    EXPECT_EQ(measures.strains[1].fabric, "wool");
    EXPECT_NEAR(measures.strains[1].max, 0.0, 1e-14);
}

TEST(GarmentMeasures, LeaveOnePercentOfTheAreaAboveP99)
{
    std::vector<double> stretches(200, 1.0);
    stretches[7] = 1.2; // half a percent of the area
    EXPECT_NEAR(measure_garment({squares(stretches), {}}, pattern_of({}), "wool").strains[0].p99, 0.0, 1e-14);
    stretches[8] = stretches[9] = 1.1;
    const FabricStrain strain = measure_garment({squares(stretches), {}}, pattern_of({}), "wool").strains[0];
    EXPECT_NEAR(strain.p99, 0.1, 1e-14);
    EXPECT_NEAR(strain.max, 0.2, 1e-14);
    EXPECT_NEAR(strain.mean, 0.4 / 200.0, 1e-14);
}

/// Sander et al. 2001 for areas 1 and 1 in the texture, 1.1 and 1 in space.
TEST(GarmentMeasures, HaveTheStretchOfTheLiterature)
{
    const UvStretch uv = measure_garment({squares({1.1, 1.0}), {}}, pattern_of({}), "wool").uv;
    EXPECT_NEAR(uv.area_ratio, 1.05, 1e-14);
    const double squared = (0.5 * (1.1 * 1.1 + 1.0) * 1.1 + 1.0) / 2.1;
    EXPECT_NEAR(uv.l2, std::sqrt(squared * 2.0 / 2.1), 1e-14);
    EXPECT_NEAR(uv.linf, 1.1 * std::sqrt(2.0 / 2.1), 1e-14);
}

TEST(GarmentMeasures, HaveNoDistortionInAnEnlargedSheet)
{
    ObjMesh mesh = squares({1.0, 1.0});
    for (Vec3& p : mesh.positions)
        p *= 3.0;
    const UvStretch uv = measure_garment({mesh, {}}, pattern_of({}), "wool").uv;
    EXPECT_NEAR(uv.l2, 1.0, 1e-14);
    EXPECT_NEAR(uv.linf, 1.0, 1e-14);
    EXPECT_NEAR(uv.area_ratio, 9.0, 1e-13);
}

TEST(GarmentMeasures, NeverHaveAStretchBelowOne)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int k = 0; k < 100; ++k) {
        ObjMesh mesh = squares({1.0, 1.0, 1.0});
        for (Vec3& p : mesh.positions)
            p = Vec3(number(random), number(random), number(random));
        const UvStretch uv = measure_garment({mesh, {}}, pattern_of({}), "wool").uv;
        EXPECT_GE(uv.l2, 1.0);
        EXPECT_GE(uv.linf, uv.l2);
    }
}

TEST(GarmentMeasures, NameThePanelOfATriangleAndOfAPlace)
{
    const ObjMesh mesh = squares({1.0, 1.0, 1.0});
    EXPECT_EQ(panel_of_triangle(mesh, 0), "0");
    EXPECT_EQ(panel_of_triangle(mesh, 1), "0");
    EXPECT_EQ(panel_of_triangle(mesh, 5), "2");
    EXPECT_EQ(panel_near(mesh, Vec3(0.0, 0.5, 2.6)).name, "1");
    EXPECT_EQ(panel_near({}, Vec3::Zero()).name, "");
}

} // namespace
} // namespace toile::test
