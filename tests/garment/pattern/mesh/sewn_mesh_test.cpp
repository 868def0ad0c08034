#include "garment/pattern/mesh/sewn_mesh.h"

#include <gtest/gtest.h>

#include "core/mesh/topology.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

struct Expected {
    int pieces, border_loops, euler_characteristic;
};

/// Checks the numbers, and by an independent path that windings agree along every edge.
void expect_topology(const SewnMesh& sewn, const Expected& expected)
{
    EXPECT_EQ(sewn.topology.pieces, expected.pieces);
    EXPECT_EQ(sewn.topology.border_loops, expected.border_loops);
    EXPECT_EQ(sewn.topology.euler_characteristic, expected.euler_characteristic);
    EXPECT_TRUE(sewn.topology.is_orientable());
    EXPECT_TRUE(sewn.topology.is_manifold());
    EXPECT_NO_THROW(build_topology(sewn.triangles, sewn.vertex_count, "sewn"));
}

SewnMesh sew(const Pattern& pattern, double edge) { return sewn_mesh(mesh_pattern(pattern, {edge, {}, {}})); }

/// Rectangle of 0.3 m x 0.2 m with seams between opposite edges; twisted ones join start to start.
Pattern sheet(bool sides, bool is_twisted, bool ends)
{
    Pattern pattern = pattern_of(rectangle("sheet", 0.3, 0.2));
    if (sides)
        pattern.seams.push_back(seam("side", 0, 1, 0, 3));
    if (sides && is_twisted)
        std::swap(pattern.seams[0].b[0].from, pattern.seams[0].b[0].to);
    if (ends)
        pattern.seams.push_back(seam("end", 0, 0, 0, 2));
    return pattern;
}

TEST(SewnMesh, LeavesAnUnsewnPanelAsItIs)
{
    const SewnMesh sewn = sew(sheet(false, false, false), 0.02);
    expect_topology(sewn, {1, 1, 1});
    EXPECT_EQ(sewn.vertex_count, int(sewn.welded_of.size()));
}

TEST(SewnMesh, MakesATubeOfASheet) { expect_topology(sew(sheet(true, false, false), 0.02), {1, 2, 0}); }

TEST(SewnMesh, WeldsFourCornersIntoOne)
{
    const PatternMesh mesh = mesh_pattern(sheet(true, false, true), {0.02, {}, {}});
    const SewnMesh torus = sewn_mesh(mesh);
    expect_topology(torus, {1, 0, 0});
    const int corner = torus.welded_of[0];
    ASSERT_EQ(torus.members[corner].size(), 4u);
    for (const int vertex : torus.members[corner])
        EXPECT_EQ(torus.welded_of[vertex], corner);
}

TEST(SewnMesh, NamesTheSeamOfAOneSidedSurface)
{
    const SewnMesh moebius = sew(sheet(true, true, false), 0.02);
    ASSERT_TRUE(moebius.topology.one_sided_seam);
    EXPECT_EQ(*moebius.topology.one_sided_seam, 0);
    EXPECT_EQ(moebius.topology.border_loops, 1);
    EXPECT_EQ(moebius.topology.euler_characteristic, 0);

    // Of the four seams of a skirt with a yoke, the third has its ends swapped.
    Pattern skirt = front_and_back(rectangle("front", 0.4, 0.5), {1, 3});
    skirt.panels.push_back(rectangle("yoke", 0.8, 0.1));
    skirt.seams.push_back(seam("yoke", 2, 1, 2, 3));
    std::swap(skirt.seams[2].b[0].from, skirt.seams[2].b[0].to);
    EXPECT_EQ(sew(skirt, 0.05).topology.one_sided_seam, 2);
}

TEST(SewnMesh, TurnsAPanelThatIsSewnFrontToBack)
{
    // Both side seams join start to start: the back lies with its outside inside.
    Pattern pattern = front_and_back(rectangle("front", 0.3, 0.4), {1, 3});
    for (Seam& side : pattern.seams)
        std::swap(side.b[0].from, side.b[0].to);
    const PatternMesh mesh = mesh_pattern(pattern, {0.03, {}, {}});
    const SewnMesh sewn = sewn_mesh(mesh);
    expect_topology(sewn, {1, 2, 0});
    EXPECT_EQ(sewn.is_turned, (std::vector{false, true}));
    EXPECT_EQ(sewn.corners[0], mesh.triangles[0]);
    const Triangle& last = mesh.triangles.back();
    EXPECT_EQ(sewn.corners.back(), Triangle(last[0], last[2], last[1]));
}

TEST(SewnMesh, KeepsTheCornersOfThePatternMesh)
{
    const PatternMesh mesh = mesh_pattern(tee(), {0.03, {}, {}});
    const SewnMesh sewn = sewn_mesh(mesh);
    ASSERT_EQ(sewn.triangles.size(), mesh.triangles.size());
    for (size_t t = 0; t < sewn.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(sewn.triangles[t][k], sewn.welded_of[sewn.corners[t][k]]);
}

TEST(SewnMesh, HasTheOpeningsOfGarments)
{
    for (const double edge : {0.05, 0.02, 0.007}) {
        SCOPED_TRACE(edge);
        expect_topology(sew(front_and_back(rectangle("front", 0.4, 0.5), {1, 3}), edge), {1, 2, 0});
        expect_topology(sew(trousers(), edge), {1, 3, -1});
        expect_topology(sew(tee(), edge), {1, 4, -2});
    }
}

TEST(SewnMesh, CountsPieces)
{
    Pattern pattern = tee();
    pattern.panels.push_back(rectangle("scarf", 0.2, 1.0));
    EXPECT_EQ(sew(pattern, 0.03).topology.pieces, 2);
}

TEST(SewnMesh, StaysManifoldWhereBothPanelsCutTheSameCorner)
{
    // Pillows: at corners below 60 degrees one triangle fills the corner of each panel, with the same ends.
    for (const double height : {0.05, 0.1, 0.2, 0.35})
        for (const double edge : {0.1, 0.05, 0.02}) {
            SCOPED_TRACE(testing::Message() << height << " at " << edge);
            const Panel triangle = polygon("front", {{-0.2, 0.0}, {0.2, 0.0}, {0.0, height}});
            expect_topology(sew(front_and_back(triangle, {0, 1, 2}), edge), {1, 0, 2});
        }
}

TEST(SewnMesh, StaysManifoldInAStrapOfTwoLayers)
{
    expect_topology(sew(front_and_back(rectangle("strap", 0.4, 0.008), {0, 2}), 0.01), {1, 2, 0});
}

TEST(SewnMesh, KeepsNarrowOpenings)
{
    // Each end of the sleeve is one edge of front and back: both would become one edge, without an opening.
    const PatternMesh mesh =
        mesh_pattern(front_and_back(rectangle("sleeve", 0.4, 0.09), {0, 2}), {0.1, {}, {}});
    EXPECT_EQ(mesh.edge_vertices[0][1].size(), 3u);
    expect_topology(sewn_mesh(mesh), {1, 2, 0});
}

TEST(SewnMesh, StaysManifoldAtTheTipOfACone)
{
    for (const double angle : {0.15, 0.4, 1.0, 2.0})
        for (const double edge : {0.2, 0.02}) {
            SCOPED_TRACE(testing::Message() << angle << " at " << edge);
            Pattern cone = pattern_of(
                polygon("cone", {{0.0, 0.0}, {0.3, 0.0}, {0.3 * std::cos(angle), 0.3 * std::sin(angle)}}));
            cone.seams = {seam("side", 0, 0, 0, 2)};
            expect_topology(sew(cone, edge), {1, 1, 1});
        }
}

TEST(SewnMesh, ReportsWhatIsNotManifold)
{
    // Three triangles on one edge, as three panels sewn along one seam would have.
    PatternMesh mesh;
    mesh.first_vertex = {0, 3, 6, 9};
    mesh.first_triangle = {0, 1, 2, 3};
    mesh.edge = {1.0, 1.0, 1.0};
    for (int p = 0; p < 3; ++p) {
        const int v = 3 * p;
        mesh.uv.insert(mesh.uv.end(), {Vec2(0.0, 0.0), Vec2(1.0, 0.0), Vec2(0.5, 1.0)});
        mesh.triangles.emplace_back(v, v + 1, v + 2);
        mesh.edge_vertices.push_back(
            {{{v, 0.0}, {v + 1, 1.0}}, {{v + 1, 0.0}, {v + 2, 1.0}}, {{v + 2, 0.0}, {v, 1.0}}});
    }
    mesh.stitches = {{{0, 3}, {1, 4}}, {{3, 6}, {4, 7}}};
    const SewnTopology topology = sewn_mesh(mesh).topology;
    ASSERT_EQ(topology.non_manifold_edges.size(), 1u);
    EXPECT_EQ(topology.non_manifold_edges[0], (std::array{0, 1}));
    EXPECT_TRUE(topology.duplicate_triangles.empty());

    mesh.stitches = {{{2, 5}, {0, 3}, {1, 4}}, {{7, 8}}};
    const SewnTopology folded = sewn_mesh(mesh).topology;
    EXPECT_EQ(folded.duplicate_triangles, std::vector{1});
    EXPECT_EQ(folded.collapsed_triangles, std::vector{2});
}

} // namespace

} // namespace toile::garment::test
