#include <array>
#include <map>

#include <gtest/gtest.h>

#include "garment/pattern/check_pattern.h"
#include "garment/pattern/mesh/gathers.h"
#include "garment/pattern/mesh/pattern_mesh.h"
#include "garment/pattern/mesh/resampling.h"
#include "garment/pattern/mesh/sewn_mesh.h"
#include "garment/pattern/sewn_sides.h"
#include "tests/garment/pattern/mesh/patterns.h"

/// Seams on lines inside of panels, as those of pockets.
namespace toile::garment::test {

namespace {

const Vec2 kPlace(0.1, 0.05); // [m] of the pocket's lower left corner on the front

/// A front of 40 x 30 cm with a pocket of 12 x 10 cm, open at its top.
/// @param ease  length of the pocket's edges over that of the line
Pattern pocket_on_front(double ease = 1.0)
{
    Pattern pattern = pattern_of(rectangle("front", 0.4, 0.3));
    pattern.panels.push_back(rectangle("pocket", 0.12 * ease, 0.1 * ease));
    pattern.source = "pocket";
    pattern.panels[0].lines = {
        {"place", {kPlace + Vec2(0.0, 0.1), kPlace, kPlace + Vec2(0.12, 0.0), kPlace + Vec2(0.12, 0.1)}}};
    Seam seam;
    seam.a = {{0, 4, 0.0, 1.0}};
    seam.b = {{1, 3, 0.0, 1.0}, {1, 0, 0.0, 1.0}, {1, 1, 0.0, 1.0}};
    seam.name = "pocket";
    pattern.seams = {seam};
    return pattern;
}

PatternMesh mesh_of(const Pattern& pattern, double edge)
{
    PatternMeshSettings settings;
    settings.edge = edge;
    return mesh_pattern(pattern, settings);
}

/// Number of triangles at each edge of a sewn surface, by its vertices.
std::map<std::array<int, 2>, int> triangles_at_edges(const SewnMesh& sewn)
{
    std::map<std::array<int, 2>, int> count;
    for (const Triangle& t : sewn.triangles)
        for (int k = 0; k < 3; ++k)
            ++count[{std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}];
    return count;
}

} // namespace

TEST(InnerSeam, JoinsPointsThatLieOnEachOther)
{
    const Pattern pattern = pocket_on_front();
    require_sewable(pattern);
    const PatternMesh mesh = mesh_of(pattern, 0.017);
    const auto& pairs = mesh.stitches[0];
    ASSERT_EQ(pairs.size(), 1u + 6u + 8u + 6u);
    for (const auto& [line, pocket] : pairs) {
        EXPECT_EQ(mesh.panel_of_vertex(line), 0);
        EXPECT_EQ(mesh.panel_of_vertex(pocket), 1);
        EXPECT_LT((mesh.uv[size_t(line)] - mesh.uv[size_t(pocket)] - kPlace).norm(), 1e-12);
    }
    EXPECT_TRUE(mesh.is_inner_seam[0]);
    EXPECT_NEAR(area_of(mesh, 0), 0.12, 1e-14);
    EXPECT_NEAR(area_of(mesh, 1), 0.012, 1e-14);
    EXPECT_GT(smallest_angle_deg(mesh), 25.0);
}

TEST(InnerSeam, MakesThreeTrianglesMeetAlongTheLineAlone)
{
    const Pattern pattern = pocket_on_front();
    const PatternMesh mesh = mesh_of(pattern, 0.017);
    const SewnMesh sewn = sewn_mesh(mesh);
    int branching = 0;
    for (const auto& [ends, count] : triangles_at_edges(sewn)) {
        EXPECT_LE(count, 3);
        branching += count == 3;
    }
    EXPECT_EQ(branching, int(mesh.stitches[0].size()) - 1);
    EXPECT_EQ(sewn.topology.pieces, 1);
    EXPECT_EQ(sewn.topology.border_loops, 2) << "of the front and of the pocket";
    EXPECT_EQ(sewn.topology.euler_characteristic, 1) << "two discs that share a path";
    EXPECT_TRUE(sewn.topology.is_manifold());
    EXPECT_EQ(sewn.is_turned, (std::vector<bool>{false, false}));
    EXPECT_TRUE(sewn_sides(pattern).one_sided.empty());
}

TEST(InnerSeam, MaySewABadgeAllAround)
{
    Pattern pattern = pocket_on_front();
    pattern.panels[0].lines[0].points.push_back(pattern.panels[0].lines[0].points.front());
    pattern.seams[0].b.push_back({1, 2, 0.0, 1.0});
    const PatternMesh mesh = mesh_of(pattern, 0.017);
    for (const auto& [line, badge] : mesh.stitches[0])
        EXPECT_LT((mesh.uv[size_t(line)] - mesh.uv[size_t(badge)] - kPlace).norm(), 1e-12);
    const SewnMesh sewn = sewn_mesh(mesh);
    EXPECT_EQ(sewn.topology.euler_characteristic, 2) << "two discs that share a circle";
}

/// What is closed on the coarse mesh stays closed on the fine one.
TEST(InnerSeam, IsResampledAlikeOnBothSides)
{
    const Pattern pattern = pocket_on_front();
    const PatternMesh coarse = mesh_of(pattern, 0.04), fine = mesh_of(pattern, 0.015);
    const SewnMesh sewn = sewn_mesh(coarse);
    std::vector<double> value; // equal where it is welded
    for (const int v : sewn.welded_of)
        value.push_back(std::sin(100.0 * v));
    const std::vector<double> sampled = resample(coarse, fine).apply(coarse, value);
    for (const auto& [line, pocket] : fine.stitches[0])
        EXPECT_NEAR(sampled[size_t(line)], sampled[size_t(pocket)], 1e-9);
}

TEST(InnerSeam, GathersALargerPocketToItsLine)
{
    const Pattern pattern = pocket_on_front(1.1);
    const PatternMesh mesh = mesh_of(pattern, 0.017);
    const std::vector<FlatTriangle> rest = gathered_rest(pattern, mesh);
    std::map<std::array<int, 2>, double> length; // at rest, of edges of the mesh
    for (size_t t = 0; t < rest.size(); ++t)
        for (size_t k = 0; k < 3; ++k)
            length[{mesh.triangles[t][int(k)], mesh.triangles[t][int(k + 1) % 3]}] =
                (rest[t][(k + 1) % 3] - rest[t][k]).norm();
    const auto& pairs = mesh.stitches[0];
    for (size_t i = 0; i + 1 < pairs.size(); ++i) {
        const double line = (mesh.uv[size_t(pairs[i][0])] - mesh.uv[size_t(pairs[i + 1][0])]).norm();
        EXPECT_NEAR((length[{pairs[i][1], pairs[i + 1][1]}]), line, 1e-9);
    }
}

/// Points of closures and attachments are vertices, on the outline and inside, where there is room for them.
TEST(PanelPoints, AreVerticesOfTheMesh)
{
    Pattern pattern = pattern_of(rectangle("front", 0.4, 0.3));
    pattern.panels.push_back(mirrored(rectangle("back", 0.4, 0.3), "back"));
    pattern.closures = {{{0, {0.123, 0.145}}, {1, {-0.301, 0.0777}}, 0.0, "inside"},
                        {{0, {0.1234, 0.3}}, {1, {0.0, 0.111}}, 0.0, "on the outline"},
                        {{0, {0.2, 0.001}}, {0, {0.124, 0.146}}, 0.0, "beside the outline and another"}};
    pattern.attachments = {{{}, {{0, {0.25, 0.05}}}, false}};
    for (const double edge : {0.05, 0.013}) {
        const PatternMesh mesh = mesh_of(pattern, edge);
        const auto distance = [&](const PanelPoint& point) {
            double nearest = 1.0;
            for (int v = mesh.first_vertex[size_t(point.panel)];
                 v < mesh.first_vertex[size_t(point.panel) + 1]; ++v)
                nearest = std::min(nearest, (mesh.uv[size_t(v)] - point.point).norm());
            return nearest;
        };
        for (int c = 0; c < 2; ++c)
            for (const PanelPoint& end : {pattern.closures[size_t(c)].a, pattern.closures[size_t(c)].b})
                EXPECT_LT(distance(end), 1e-6) << pattern.closures[size_t(c)].name;
        EXPECT_LT(distance(pattern.attachments[0].points[0]), 1e-12);
        EXPECT_LT(distance(pattern.closures[2].b), 0.002);
        EXPECT_GT(smallest_angle_deg(mesh), 20.0);
        EXPECT_NEAR(area_of(mesh, 0), 0.12, 1e-14);
    }
}

} // namespace toile::garment::test
