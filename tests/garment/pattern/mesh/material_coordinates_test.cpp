#include "garment/pattern/mesh/material_coordinates.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "garment/pattern/mesh/gathers.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

/// Warp of a panel in its own plane, and the direction across it to the right.
Vec2 warp(double grain_deg)
{
    const double angle = grain_deg * std::numbers::pi / 180.0;
    return {-std::sin(angle), std::cos(angle)};
}
Vec2 weft(double grain_deg) { return {warp(grain_deg).y(), -warp(grain_deg).x()}; }

TEST(MaterialCoordinates, HaveTheWarpUpwards)
{
    Pattern pattern = pattern_of(polygon("front", {{0.0, 0.0}, {0.3, 0.0}, {0.2, 0.4}}));
    pattern.panels.push_back(mirrored(rectangle("back", 0.2, 0.3), "back"));
    pattern.panels.push_back(rectangle("upright", 0.2, 0.3));
    const std::array<double, 3> grain{30.0, -100.0, 0.0};
    for (size_t p = 0; p < 3; ++p)
        pattern.panels[p].grain_deg = grain[p];
    const PatternMesh mesh = mesh_pattern(pattern, {0.03, {}, {}});
    const std::vector<Vec2> material = material_coordinates(pattern, mesh);
    ASSERT_EQ(material.size(), mesh.uv.size());
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        const double g = grain[size_t(mesh.panel_of_vertex(v))];
        EXPECT_NEAR(material[size_t(v)].x(), weft(g).dot(mesh.uv[size_t(v)]), 1e-15);
        EXPECT_NEAR(material[size_t(v)].y(), warp(g).dot(mesh.uv[size_t(v)]), 1e-15);
    }
    for (int v = mesh.first_vertex[2]; v < mesh.vertex_count(); ++v)
        EXPECT_EQ(material[size_t(v)], mesh.uv[size_t(v)]);
}

TEST(MaterialCoordinates, ShrinkAlongTheGrain)
{
    Pattern pattern = pattern_of(rectangle("front", 0.2, 0.3));
    pattern.panels[0].grain_deg = 20.0;
    pattern.panels[0].shrink_warp = 0.9;
    pattern.panels[0].shrink_weft = 0.95;
    const PatternMesh mesh = mesh_pattern(pattern, {0.05, {}, {}});
    const std::vector<Vec2> material = material_coordinates(pattern, mesh);
    for (size_t v = 0; v < material.size(); ++v) {
        EXPECT_NEAR(material[v].x(), 0.95 * weft(20.0).dot(mesh.uv[v]), 1e-15);
        EXPECT_NEAR(material[v].y(), 0.9 * warp(20.0).dot(mesh.uv[v]), 1e-15);
    }
}

/// Gathers neither depend on the grain, nor does it bend their triangles.
TEST(MaterialCoordinates, TurnGatheredTriangles)
{
    Pattern pattern = pattern_of(rectangle("band", 0.2, 0.12));
    pattern.panels.push_back(rectangle("skirt", 0.4, 0.3));
    pattern.seams.push_back(seam("waist", 0, 0, 1, 2));
    const PatternMesh mesh = mesh_pattern(pattern, {0.02, {}, {}});
    const std::vector<FlatTriangle> upright = gathered_rest(pattern, mesh);
    pattern.panels[1].grain_deg = 45.0;
    const std::vector<FlatTriangle> bias = gathered_rest(pattern, mesh);
    for (int t = 0; t < mesh.triangle_count(); ++t)
        for (int k = 0; k < 3; ++k) {
            const Vec2 e = upright[size_t(t)][size_t((k + 1) % 3)] - upright[size_t(t)][size_t(k)];
            const Vec2 f = bias[size_t(t)][size_t((k + 1) % 3)] - bias[size_t(t)][size_t(k)];
            const double g = mesh.panel_of_triangle(t) == 1 ? 45.0 : 0.0;
            EXPECT_LT((f - Vec2(weft(g).dot(e), warp(g).dot(e))).norm(), 1e-14);
        }
}

} // namespace

} // namespace toile::garment::test
