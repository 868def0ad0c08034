#include "garment/pattern/mesh/pattern_mesh.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "garment/pattern/edge_curve.h"
#include "garment/pattern/mesh/mesh_quality.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr double kPi = std::numbers::pi;

std::string error_of(const Pattern& pattern, const PatternMeshSettings& settings)
{
    try {
        mesh_pattern(pattern, settings);
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

double degrees(double angle) { return angle * 180.0 / kPi; }

/// Area of a polygon of `count` sides in a circle. [m^2]
double inscribed_area(double radius, int count)
{
    return 0.5 * count * radius * radius * std::sin(2.0 * kPi / count);
}

TEST(MeshPattern, CoversARectangleWithGoodTriangles)
{
    const PatternMesh mesh = mesh_pattern(pattern_of(rectangle("front", 0.4, 0.3)), {0.01, {}, {}});
    EXPECT_NEAR(area_of(mesh), 0.12, 1e-14);
    const MeshQuality quality = quality_of(mesh);
    EXPECT_GT(degrees(quality.smallest_angle), 30.0);
    EXPECT_GT(quality.in_range, 0.99);
    EXPECT_NEAR(quality.mean_edge, 1.0, 0.03);
    const double equilateral = 0.12 / (std::sqrt(0.75) * 1e-4) + 0.5 * 140;
    EXPECT_NEAR(quality.vertices, equilateral, 0.05 * equilateral);
}

TEST(MeshPattern, CoversADiscOfArcs)
{
    const PatternMesh mesh = mesh_pattern(pattern_of(disc("patch", 0.1)), {0.01, {}, {}});
    const int sides = 2 * int(std::ceil(0.1 * kPi / 0.01));
    ASSERT_EQ(mesh.edge_vertices[0][0].size() + mesh.edge_vertices[0][1].size() - 2, size_t(sides));
    // Arcs are chains of 512 chords.
    EXPECT_NEAR(area_of(mesh), inscribed_area(0.1, sides), 1e-6 * 0.0314);
    for (const auto& edge : mesh.edge_vertices[0])
        for (const EdgeVertex& vertex : edge)
            EXPECT_NEAR(mesh.uv[vertex.vertex].norm(), 0.1, 1e-6);
    EXPECT_GT(smallest_angle_deg(mesh), 30.0);
}

TEST(MeshPattern, CoversHalfACircleSkirt)
{
    const PatternMesh mesh = mesh_pattern(pattern_of(half_ring("skirt", 0.11, 0.7)), {0.015, {}, {}});
    const int hem = int(mesh.edge_vertices[0][0].size()) - 1,
              waist = int(mesh.edge_vertices[0][2].size()) - 1;
    EXPECT_NEAR(area_of(mesh), 0.5 * (inscribed_area(0.7, 2 * hem) - inscribed_area(0.11, 2 * waist)), 1e-5);
    EXPECT_GT(smallest_angle_deg(mesh), 30.0);
    EXPECT_GT(quality_of(mesh).in_range, 0.99);
}

TEST(MeshPattern, OrientsTrianglesAlongTheLoop)
{
    Pattern pattern = pattern_of(half_ring("front", 0.1, 0.4));
    pattern.panels.push_back(mirrored(pattern.panels[0], "back"));
    const PatternMesh mesh = mesh_pattern(pattern, {0.02, {}, {}});
    EXPECT_LT(signed_area(pattern.panels[1]), 0.0);
    EXPECT_GT(area_of(mesh, 0), 0.0);
    EXPECT_NEAR(area_of(mesh, 1), -area_of(mesh, 0), 1e-15);
    for (int v = mesh.first_vertex[1]; v < mesh.vertex_count(); ++v)
        EXPECT_EQ(mesh.uv[v].y(), mesh.uv[v - mesh.first_vertex[1]].y()) << "mirrored, the mesh is the same";
}

TEST(MeshPattern, NumbersVerticesByPanelAlongTheLoop)
{
    Pattern pattern = pattern_of(rectangle("front", 0.1, 0.2));
    pattern.panels.push_back(rectangle("back", 0.1, 0.1));
    const PatternMesh mesh = mesh_pattern(pattern, {0.05, {}, {}});
    ASSERT_EQ(mesh.first_vertex.size(), 3u);
    EXPECT_EQ(mesh.panel_of_vertex(0), 0);
    EXPECT_EQ(mesh.panel_of_vertex(mesh.first_vertex[1] - 1), 0);
    EXPECT_EQ(mesh.panel_of_vertex(mesh.first_vertex[1]), 1);
    EXPECT_EQ(mesh.panel_of_triangle(mesh.triangle_count() - 1), 1);
    int next = 0;
    for (const auto& edge : mesh.edge_vertices[0]) {
        for (size_t i = 0; i + 1 < edge.size(); ++i)
            EXPECT_EQ(edge[i].vertex, next++);
        EXPECT_EQ(edge.back().vertex, next % 12);
    }
    EXPECT_EQ(mesh.uv[mesh.edge_vertices[1][2].front().vertex], Vec2(0.1, 0.1));
}

TEST(MeshPattern, StitchesDartsUpToTheirTip)
{
    // A square with a dart from its top: edges 3 and 4 share the tip, corner 4.
    Pattern pattern = pattern_of(polygon(
        "front", {{0.0, 0.0}, {0.3, 0.0}, {0.3, 0.3}, {0.17, 0.3}, {0.15, 0.18}, {0.13, 0.3}, {0.0, 0.3}}));
    pattern.seams = {seam("dart", 0, 3, 0, 4)};
    const PatternMesh mesh = mesh_pattern(pattern, {0.01, {}, {}});
    const auto &right = mesh.edge_vertices[0][3], &left = mesh.edge_vertices[0][4];
    ASSERT_EQ(right.back().vertex, left.front().vertex);
    ASSERT_EQ(mesh.stitches[0].size(), right.size() - 1);
    for (size_t i = 0; i + 1 < right.size(); ++i) {
        EXPECT_EQ(mesh.stitches[0][i][0], right[i].vertex);
        EXPECT_EQ(mesh.stitches[0][i][1], left[left.size() - 1 - i].vertex);
    }
    EXPECT_GT(smallest_angle_deg(mesh), 30.0);
}

TEST(MeshPattern, RefinesPanelsThatAreNarrowerThanTheTarget)
{
    const PatternMesh strap = mesh_pattern(pattern_of(rectangle("strap", 0.4, 0.005)), {0.02, {}, {}});
    EXPECT_NEAR(strap.edge[0], 0.0074, 1e-4);
    EXPECT_NEAR(area_of(strap), 0.002, 1e-15);
    EXPECT_GT(smallest_angle_deg(strap), 20.0);

    const PatternMesh label = mesh_pattern(pattern_of(rectangle("label", 0.01, 0.01)), {0.5, {}, {}});
    EXPECT_NEAR(area_of(label), 1e-4, 1e-17);
    EXPECT_GT(smallest_angle_deg(label), 20.0);

    const PatternMesh sliver = mesh_pattern(pattern_of(rectangle("sliver", 1.0, 1e-5)), {0.02, {}, {}});
    EXPECT_LT(sliver.vertex_count(), 1100) << "not a million of vertices for a mistake";
    EXPECT_NEAR(area_of(sliver), 1e-5, 1e-15);

    const PatternMesh coarse_disc = mesh_pattern(pattern_of(disc("button", 0.01)), {0.5, {}, {}});
    EXPECT_GE(coarse_disc.edge_vertices[0][0].size(), 4u);
}

TEST(MeshPattern, RefinesCurvesUntilTheirChordsAreSimple)
{
    // A crescent between two arcs that a few chords would make cross.
    Panel crescent = polygon("crescent", {{-0.2, 0.0}, {0.2, 0.0}});
    crescent.edges[0].curve = CircularArc{0.2, false, true};
    crescent.edges[1].curve = CircularArc{0.2001, false, false};
    const PatternMesh mesh = mesh_pattern(pattern_of(crescent), {0.1, {}, {}});
    EXPECT_GT(area_of(mesh), 0.0);
    EXPECT_LT(mesh.edge[0], 0.01);
}

TEST(MeshPattern, KeepsFreeAnglesLargeBesideSharpCorners)
{
    for (const double height : {0.05, 0.1, 0.2}) {
        const PatternMesh mesh = mesh_pattern(
            pattern_of(polygon("godet", {{0.0, 0.0}, {0.5, 0.0}, {0.0, height}})), {0.01, {}, {}});
        const MeshQuality quality = quality_of(mesh);
        EXPECT_GT(degrees(quality.smallest_free_angle), 20.0) << height;
        EXPECT_LE(degrees(quality.smallest_angle), degrees(std::atan2(height, 0.5)) + 1e-9);
        EXPECT_GT(degrees(quality.smallest_angle), 0.45 * degrees(std::atan2(height, 0.5))) << height;
    }
}

TEST(MeshPattern, HasTheSameBitsInEveryRun)
{
    Pattern pattern = tee();
    pattern.panels[0].edges[0].curve = Bezier{{Vec2(0.0, -0.1)}};
    const PatternMesh a = mesh_pattern(pattern, {0.013, {}, {}});
    // Blocks that others hold scatter the next meshes over memory: nothing may depend on addresses.
    std::vector<std::unique_ptr<std::array<char, 3000>>> blocks;
    for (const double other : {0.02, 0.01, 0.03}) {
        mesh_pattern(pattern_of(disc("patch", 0.3)), {other, {}, {}});
        for (int i = 0; i < 200; ++i)
            blocks.push_back(std::make_unique<std::array<char, 3000>>());
        for (size_t i = 0; i < blocks.size(); i += 2)
            blocks[i].reset();
        const PatternMesh b = mesh_pattern(pattern, {0.013, {}, {}});
        EXPECT_EQ(a.uv, b.uv);
        EXPECT_EQ(a.triangles, b.triangles);
        EXPECT_EQ(a.stitches, b.stitches);
    }
}

TEST(MeshPattern, DoesNotDependOnTheUnit)
{
    Pattern pattern = pattern_of(half_ring("skirt", 0.125, 0.5)), doubled = pattern;
    for (Vec2& corner : doubled.panels[0].corners)
        corner *= 2.0;
    for (PanelEdge& edge : doubled.panels[0].edges)
        if (auto* arc = std::get_if<CircularArc>(&edge.curve))
            arc->radius *= 2.0;
    const PatternMesh a = mesh_pattern(pattern, {0.02, {}, {}}), b = mesh_pattern(doubled, {0.04, {}, {}});
    EXPECT_EQ(a.triangles, b.triangles);
    ASSERT_EQ(a.vertex_count(), b.vertex_count());
    for (int v = 0; v < a.vertex_count(); ++v)
        EXPECT_EQ(2.0 * a.uv[v], b.uv[v]);
}

TEST(MeshPattern, TakesATargetForEachPanel)
{
    Pattern pattern = pattern_of(rectangle("front", 0.2, 0.2));
    pattern.panels.push_back(rectangle("back", 0.2, 0.2));
    const PatternMesh mesh = mesh_pattern(pattern, {0.5, {0.02, 0.01}, {}});
    EXPECT_EQ(mesh.edge, (std::vector{0.02, 0.01}));
    EXPECT_GT(mesh.first_vertex[2] - mesh.first_vertex[1], 3 * mesh.first_vertex[1]);
    EXPECT_THAT(error_of(pattern, {0.01, {0.01}, {}}), HasSubstr("1 targets of edge lengths for 2 panels"));
}

TEST(MeshPattern, RefusesTargetsThatAreNotPositive)
{
    const Pattern pattern = pattern_of(rectangle("front", 0.2, 0.2));
    for (const double edge : {0.0, -0.01, std::nan(""), HUGE_VAL})
        EXPECT_THAT(error_of(pattern, {edge, {}, {}}),
                    AllOf(HasSubstr("test.json: panel \"front\""), HasSubstr("must be positive")));
}

TEST(MeshPattern, RefusesAbsurdNumbersOfVertices)
{
    // 20 m in a pattern that should have had 0.2 m.
    const std::string error = error_of(pattern_of(rectangle("front", 20.0, 20.0)), {0.005, {}, {}});
    EXPECT_THAT(error, AllOf(HasSubstr("test.json: edges of 0.005 m would give 1.8e+07 vertices"),
                             HasSubstr("use 0.012 m")));
}

} // namespace

} // namespace toile::garment::test
