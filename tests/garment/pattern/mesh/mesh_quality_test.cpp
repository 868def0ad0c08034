#include "garment/pattern/mesh/mesh_quality.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

/// A rectangle of 2 m x 1 m in two triangles, target 1 m.
PatternMesh two_triangles()
{
    PatternMesh mesh;
    mesh.uv = {{0.0, 0.0}, {2.0, 0.0}, {2.0, 1.0}, {0.0, 1.0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.first_vertex = {0, 4};
    mesh.first_triangle = {0, 2};
    mesh.edge = {1.0};
    mesh.edge_vertices = {
        {{{0, 0.0}, {1, 1.0}}, {{1, 0.0}, {2, 1.0}}, {{2, 0.0}, {3, 1.0}}, {{3, 0.0}, {0, 1.0}}}};
    return mesh;
}

TEST(QualityOf, MeasuresAnglesAndEdges)
{
    const MeshQuality quality = quality_of(two_triangles());
    EXPECT_EQ(quality.vertices, 4);
    EXPECT_EQ(quality.triangles, 2);
    EXPECT_NEAR(quality.smallest_angle, std::atan(0.5), 1e-15);
    EXPECT_EQ(quality.shortest_edge, 1.0);
    EXPECT_NEAR(quality.longest_edge, std::sqrt(5.0), 1e-15);
    EXPECT_NEAR(quality.mean_edge, (6.0 + std::sqrt(5.0)) / 5.0, 1e-15);
    EXPECT_NEAR(quality.in_range, 0.4, 1e-15);
}

TEST(QualityOf, LeavesForcedPlacesOut)
{
    // Both triangles lie between outline and outline.
    EXPECT_EQ(quality_of(two_triangles()).forced_triangles, 2);
    EXPECT_EQ(quality_of(two_triangles()).smallest_free_angle, std::numbers::pi);

    // With a vertex in the middle they are free.
    PatternMesh mesh = two_triangles();
    mesh.uv.emplace_back(1.0, 0.5);
    mesh.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
    mesh.first_vertex = {0, 5};
    mesh.first_triangle = {0, 4};
    EXPECT_EQ(quality_of(mesh).forced_triangles, 0);
    EXPECT_NEAR(quality_of(mesh).smallest_free_angle, std::atan(0.5), 1e-15);

    // The outline is sharp in one corner: its two triangles are forced.
    PatternMesh sharp = mesh;
    sharp.uv[3] = Vec2(1.0, 1.1);
    EXPECT_EQ(quality_of(sharp).forced_triangles, 2);

    // Two sides are short for their panel, and touch all triangles.
    mesh.edge = {1.9};
    EXPECT_EQ(quality_of(mesh).forced_triangles, 4);
}

TEST(QualityOf, OfAPanelIsThatOfAPatternOfItAlone)
{
    // Panels that nothing joins are meshed alike, alone or not.
    Pattern pattern = pattern_of(half_disc("collar", 0.2));
    pattern.panels.push_back(rectangle("band", 0.5, 0.03));
    const PatternMesh mesh = mesh_pattern(pattern, {0.02, {0.02, 0.013}, {}});
    int vertices = 0, triangles = 0;
    for (int p = 0; p < 2; ++p) {
        const MeshQuality alone =
            quality_of(mesh_pattern(pattern_of(pattern.panels[size_t(p)]), {mesh.edge[size_t(p)], {}, {}}));
        const MeshQuality quality = quality_of_panel(mesh, p);
        EXPECT_EQ(quality.vertices, alone.vertices);
        EXPECT_EQ(quality.triangles, alone.triangles);
        EXPECT_EQ(quality.smallest_angle, alone.smallest_angle);
        EXPECT_EQ(quality.smallest_angle_triangle - mesh.first_triangle[size_t(p)],
                  alone.smallest_angle_triangle);
        EXPECT_EQ(quality.smallest_free_angle, alone.smallest_free_angle);
        EXPECT_EQ(quality.forced_triangles, alone.forced_triangles);
        EXPECT_EQ(quality.in_range, alone.in_range);
        EXPECT_EQ(quality.longest_edge, alone.longest_edge);
        vertices += quality.vertices;
        triangles += quality.triangles;
    }
    EXPECT_EQ(vertices, quality_of(mesh).vertices);
    EXPECT_EQ(triangles, quality_of(mesh).triangles);
}

} // namespace

} // namespace toile::garment::test
