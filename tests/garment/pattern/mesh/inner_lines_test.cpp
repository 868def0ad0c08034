#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "garment/pattern/mesh/pattern_mesh.h"
#include "garment/pattern/mesh/sewn_mesh.h"
#include "tests/garment/pattern/mesh/patterns.h"

namespace toile::garment::test {

namespace {

using testing::AllOf;
using testing::HasSubstr;

PatternMeshSettings with_lines(const std::vector<InnerLine>& lines, double edge = 0.02)
{
    return {edge, {}, lines};
}

std::string error_of(const Pattern& pattern, const std::vector<InnerLine>& lines)
{
    try {
        mesh_pattern(pattern, with_lines(lines));
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

/// Every two consecutive vertices of a line are an edge of the mesh.
void expect_edges_along(const PatternMesh& mesh, const std::vector<int>& line)
{
    std::set<std::array<int, 2>> edges;
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k)
            edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
    for (size_t i = 0; i + 1 < line.size(); ++i)
        EXPECT_TRUE(edges.contains({std::min(line[i], line[i + 1]), std::max(line[i], line[i + 1])}));
}

TEST(InnerLine, IsFollowedByEdgesOfTheMesh)
{
    const Pattern pattern = pattern_of(rectangle("front", 0.4, 0.3));
    const InnerLine fold{0, {{0.13, 0.0}, {0.17, 0.12}, {0.13, 0.3}}, "fold"};
    const PatternMesh mesh = mesh_pattern(pattern, with_lines({fold}));
    const std::vector<int>& line = mesh.line_vertices[0];
    expect_edges_along(mesh, line);
    EXPECT_LT((mesh.uv[line.front()] - fold.points.front()).norm(), 1e-8);
    EXPECT_LT((mesh.uv[line.back()] - fold.points.back()).norm(), 1e-8);
    EXPECT_TRUE(std::any_of(line.begin(), line.end(), [&](int v) { return mesh.uv[v] == fold.points[1]; }));
    EXPECT_EQ(line.size(), 7u + 10u + 1u);
    EXPECT_NEAR(area_of(mesh), 0.12, 1e-14);
    EXPECT_GT(smallest_angle_deg(mesh), 25.0);
}

TEST(InnerLine, MayBeClosedOrEndInside)
{
    const Pattern pattern = pattern_of(mirrored(rectangle("back", 0.4, 0.3), "back"));
    const InnerLine pocket{0, {{-0.1, 0.1}, {-0.2, 0.1}, {-0.2, 0.2}, {-0.1, 0.2}, {-0.1, 0.1}}, "pocket"};
    const InnerLine slit{0, {{-0.3, 0.0}, {-0.3, 0.1}}, "slit"};
    const PatternMesh mesh = mesh_pattern(pattern, with_lines({pocket, slit}));
    expect_edges_along(mesh, mesh.line_vertices[0]);
    expect_edges_along(mesh, mesh.line_vertices[1]);
    EXPECT_EQ(mesh.line_vertices[0].front(), mesh.line_vertices[0].back());
    EXPECT_EQ(mesh.uv[mesh.line_vertices[1].back()], Vec2(-0.3, 0.1));
    EXPECT_NEAR(area_of(mesh), -0.12, 1e-14);
}

TEST(InnerLine, PutsItsEndOnWhatIsSewnToIt)
{
    Pattern pattern = front_and_back(rectangle("front", 0.4, 0.3), {1, 3});
    const InnerLine fold{0, {{0.0, 0.101}, {0.4, 0.203}}, "fold"};
    const PatternMesh mesh = mesh_pattern(pattern, with_lines({fold}));
    const SewnMesh sewn = sewn_mesh(mesh);
    const std::vector<int>& line = mesh.line_vertices[0];
    ASSERT_EQ(sewn.members[sewn.welded_of[line.front()]].size(), 2u);
    ASSERT_EQ(sewn.members[sewn.welded_of[line.back()]].size(), 2u);
    EXPECT_NEAR(mesh.uv[sewn.members[sewn.welded_of[line.back()]][1]].y(), 0.203, 1e-12);
    EXPECT_EQ(sewn.topology.border_loops, 2);
    EXPECT_TRUE(sewn.topology.is_manifold());
}

TEST(InnerLine, EndsInACornerThatIsNear)
{
    const Pattern pattern = pattern_of(half_disc("cup", 0.2));
    const PatternMesh mesh = mesh_pattern(pattern, with_lines({{0, {{-0.1999, 0.0002}, {0.0, 0.05}}, "dart"},
                                                               {0, {{0.0, 0.2}, {0.1, 0.0}}, "fold"}}));
    EXPECT_EQ(mesh.uv[mesh.line_vertices[0].front()], Vec2(-0.2, 0.0));
    EXPECT_LT((mesh.uv[mesh.line_vertices[1].front()] - Vec2(0.0, 0.2)).norm(), 1e-6) << "middle of the arc";
}

TEST(InnerLine, IsRefusedWhereItCrosses)
{
    const Pattern pattern = pattern_of(rectangle("front", 0.4, 0.3));
    const InnerLine fold{0, {{0.1, 0.0}, {0.1, 0.3}}, "fold"};
    EXPECT_THAT(
        error_of(pattern, {fold, {0, {{0.05, 0.1}, {0.3, 0.1}}, "pleat"}}),
        AllOf(HasSubstr("test.json: panel \"front\", line \""), HasSubstr("fold"), HasSubstr("pleat")));
    EXPECT_THAT(error_of(pattern, {{0, {{0.2, 0.1}, {0.5, 0.1}}, "pocket"}}),
                HasSubstr("line \"pocket\" crosses or touches the outline"));
    EXPECT_THAT(error_of(pattern, {{0, {{0.5, 0.1}, {0.6, 0.1}}, "pocket"}}), HasSubstr("lies outside"));
    EXPECT_THAT(error_of(pattern, {{0, {{0.1, 0.1}, {0.2, 0.1}, {0.15, 0.05}, {0.15, 0.2}}, "pocket"}}),
                HasSubstr("crosses or touches itself"));
    EXPECT_THAT(error_of(pattern, {{0, {{0.1, 0.1}}, "pocket"}}), HasSubstr("has 1 points"));
    EXPECT_THAT(error_of(pattern, {{0, {{0.1, 0.1}, {1e9, 0.1}}, "pocket"}}),
                HasSubstr("from point 0 to the next"));
    EXPECT_THAT(error_of(pattern, {{0, {{0.1, 0.1}, {std::nan(""), 0.1}}, "pocket"}}),
                HasSubstr("nan m from point 0"));
    EXPECT_THAT(error_of(pattern, {{0, {{0.1, 0.1}, {0.1, 0.1}}, "pocket"}}),
                HasSubstr("line \"pocket\": points 0 and 1 are the same; remove one of them"));
    EXPECT_THAT(error_of(pattern, {{0, {{0.1, 0.1}, {0.2, 0.1}, {0.2, 0.1}}, "pocket"}}),
                HasSubstr("points 1 and 2 are the same"));
    EXPECT_EQ(error_of(pattern, {fold, {0, {{0.1, 0.0}, {0.2, 0.3}}, "pleat"}}), "")
        << "both begin at one point of the outline";
    EXPECT_THAT(error_of(pattern, {fold, {0, {{0.1 + 1e-12, 0.2}, {0.2, 0.2}}, "pleat"}}),
                HasSubstr("lines or edges touch near (0.1, 0."));
    EXPECT_THAT(error_of(pattern, {{3, {{0.1, 0.1}, {0.2, 0.1}}, "pocket"}}),
                HasSubstr("panel 3 does not exist"));
}

} // namespace

} // namespace toile::garment::test
