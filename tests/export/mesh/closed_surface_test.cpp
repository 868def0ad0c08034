#include "export/mesh/closed_surface.h"

#include <map>

#include <gtest/gtest.h>

#include "tests/export/export_fixtures.h"

namespace toile::test {

namespace {

/// A quad and a triangle in the plane z = 0, of two groups.
ObjMesh flat_mesh()
{
    ObjMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}};
    mesh.texture_coordinates = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 0}};
    mesh.polygons = {{0, 1, 2, 3}, {1, 4, 2}};
    mesh.polygon_uvs = {{0, 1, 2, 3}, {1, 4, 2}};
    mesh.groups = {{0, "left"}, {1, "right"}};
    return mesh;
}

TEST(ClosedSurface, HasEveryEdgeOnceInEachDirection)
{
    const ClosedSurface closed(flat_mesh(), std::vector<double>(5, 0.002));
    std::map<std::pair<int, int>, int> edges;
    for (const std::vector<int>& polygon : closed.faces().polygons)
        for (size_t k = 0; k < polygon.size(); ++k)
            ++edges[{polygon[k], polygon[(k + 1) % polygon.size()]}];
    for (const auto& [edge, count] : edges) {
        EXPECT_EQ(count, 1) << edge.first << " to " << edge.second;
        EXPECT_TRUE(edges.contains({edge.second, edge.first})) << edge.first << " to " << edge.second;
    }
    EXPECT_EQ(closed.faces().polygons.size(), 2 + 2 + 5u);
    EXPECT_EQ(closed.faces().polygon_uvs.size(), closed.faces().polygons.size());
}

TEST(ClosedSurface, HasTheVolumeOfItsThickness)
{
    const ObjMesh mesh = flat_mesh();
    const ClosedSurface closed(mesh, {0.002, 0.002, 0.002, 0.002, 0.002});
    ObjMesh solid = closed.faces();
    solid.positions = closed.positions(mesh.positions);
    double volume = 0.0;
    for (const Triangle& t : solid.triangulated().triangles)
        volume += solid.positions[size_t(t[0])].dot(
                      solid.positions[size_t(t[1])].cross(solid.positions[size_t(t[2])])) /
                  6.0;
    EXPECT_NEAR(volume, 1.5 * 0.002, 1e-12) << "negative: the faces look inside";
}

TEST(ClosedSurface, KeepsGroupsOnBothSides)
{
    ObjMesh mesh = flat_mesh();
    mesh.groups = {{1, "right"}};
    const ObjMesh closed = ClosedSurface(mesh, std::vector<double>(5, 0.002)).faces();
    // The sides are a polygon without a group and one of "right"; the rim of five quads is between them.
    EXPECT_EQ(closed.groups, (std::vector<ObjGroup>{{1, "right"}, {2, "rim"}, {7, ""}, {8, "right"}}));
}

TEST(ClosedSurface, GivesTheClothBack)
{
    const ObjMesh mesh = flat_mesh();
    const ClosedSurface closed(mesh, {0.001, 0.002, 0.003, 0.004, 0.005});
    const std::vector<Vec3> sides = closed.positions(mesh.positions);
    EXPECT_NEAR((sides[2] - sides[7]).norm(), 0.003, 1e-12);
    const std::vector<Vec3> middle = ClosedSurface::middle(sides);
    for (size_t v = 0; v < middle.size(); ++v)
        EXPECT_NEAR((middle[v] - mesh.positions[v]).norm(), 0.0, 1e-15);
}

} // namespace
} // namespace toile::test
