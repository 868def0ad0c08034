#include "garment/pattern/mesh/placed_panels.h"

#include <gtest/gtest.h>

#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

/// A tee whose front lies 20 cm before its back, which is turned to face backwards.
Pattern placed_tee()
{
    Pattern pattern = tee();
    pattern.panels[0].placement = Eigen::Translation3d(0.0, 1.0, 0.1) * Eigen::Isometry3d::Identity();
    pattern.panels[1].placement = Eigen::Translation3d(0.0, 1.0, -0.1) * Eigen::Isometry3d::Identity();
    return pattern;
}

TEST(PlacedPanels, KeepThePatternMesh)
{
    const Pattern pattern = placed_tee();
    const PatternMesh mesh = mesh_pattern(pattern, {0.05, {}, {}});
    const ObjMesh obj = placed_panels(pattern, mesh);
    ASSERT_EQ(int(obj.positions.size()), mesh.vertex_count());
    EXPECT_EQ(obj.texture_coordinates, mesh.uv);
    EXPECT_EQ(obj.triangulated().triangles, mesh.triangles);
    EXPECT_EQ(obj.polygon_uvs, obj.polygons);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const Vec2& uv = mesh.uv[size_t(v)];
        const Vec3 expected(uv.x(), 1.0 + uv.y(), mesh.panel_of_vertex(v) == 0 ? 0.1 : -0.1);
        EXPECT_LT((obj.positions[size_t(v)] - expected).norm(), 1e-15);
    }
}

TEST(PlacedPanels, HaveAGroupForEachPanelAndALineForEachStitch)
{
    const Pattern pattern = placed_tee();
    const PatternMesh mesh = mesh_pattern(pattern, {0.05, {}, {}});
    const ObjMesh obj = placed_panels(pattern, mesh);
    EXPECT_EQ(obj.groups, (std::vector<ObjGroup>{{0, pattern.panels[0].name},
                                                 {mesh.first_triangle[1], pattern.panels[1].name}}));
    size_t pairs = 0;
    for (const auto& seam : mesh.stitches)
        pairs += seam.size();
    ASSERT_EQ(obj.lines.size(), pairs);
    for (const auto& [a, b] : obj.lines) // front and back are sewn straight through
        EXPECT_NEAR((obj.positions[size_t(a)] - obj.positions[size_t(b)]).norm(), 0.2, 1e-3);
}

/// Normals point away from the body: the loop of the back is clockwise in its plane.
TEST(PlacedPanels, FaceAwayFromTheBody)
{
    const Pattern pattern = placed_tee();
    const ObjMesh obj = placed_panels(pattern, mesh_pattern(pattern, {0.05, {}, {}}));
    for (const Triangle& t : obj.triangulated().triangles) {
        const Vec3 &a = obj.positions[size_t(t[0])], &b = obj.positions[size_t(t[1])],
                   &c = obj.positions[size_t(t[2])];
        EXPECT_GT((b - a).cross(c - a).z() * a.z(), 0.0);
    }
}

} // namespace
} // namespace toile::garment::test
