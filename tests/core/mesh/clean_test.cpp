#include <gtest/gtest.h>

#include "core/mesh/clean.h"
#include "core/mesh/topology.h"
#include "tests/core/mesh/meshes.h"

namespace toile::test {

namespace {

using Polygons = std::vector<std::vector<int>>;

/// Grid of n x n squares in the XZ plane, each with four vertices of its own.
ObjMesh loose_squares(int n)
{
    ObjMesh mesh;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const int first = int(mesh.positions.size());
            for (const auto& [x, z] : {std::pair{i, k}, {i, k + 1}, {i + 1, k + 1}, {i + 1, k}})
                mesh.positions.push_back(Vec3(0.1 * x, 0.0, 0.1 * z));
            mesh.polygons.push_back({first, first + 1, first + 2, first + 3});
        }
    return mesh;
}

/// Triangles as quadrilaterals, as game engines store them.
TEST(RepeatedCorners, AreLeftOutWithTheirTexture)
{
    ObjMesh mesh;
    mesh.positions.resize(4, Vec3::Zero());
    mesh.polygons = {{0, 1, 2, 2}, {0, 1, 2, 0}, {0, 1, 1}, {0, 1, 2, 3}, {3, 3, 3}};
    mesh.polygon_uvs = {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10}, {11, 12, 13, 14}, {15, 16, 17}};
    EXPECT_EQ(drop_repeated_corners(mesh), 4);
    EXPECT_EQ(mesh.polygons, (Polygons{{0, 1, 2}, {0, 1, 2}, {0, 1, 2, 3}}));
    EXPECT_EQ(mesh.polygon_uvs, (Polygons{{0, 1, 3}, {4, 5, 6}, {11, 12, 13, 14}}));
}

TEST(Stitch, MakesFlatShadedFacesOneSurface)
{
    ObjMesh mesh = loose_squares(5);
    const std::vector<int> stands = stitch(mesh, 1e-9);
    EXPECT_EQ(stands.size(), 100u);
    EXPECT_EQ(drop_loose_vertices(mesh).size(), 100u);
    EXPECT_EQ(mesh.positions.size(), 36u);
    const TriangleMesh triangles = mesh.triangulated();
    int borders = 0;
    for (const Edge& edge : build_topology(triangles.triangles, 36, "squares").edges)
        borders += edge.is_border() ? 1 : 0;
    EXPECT_EQ(borders, 20);
}

/// A seam down the middle of a square; it is open at both ends.
TEST(Stitch, JoinsASeamAndKeepsTheLowerVertices)
{
    ObjMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {1, 0, 0}, {2, 0, 0}, {2, 0, 1}, {1, 0, 1}};
    mesh.polygons = {{0, 3, 2, 1}, {4, 7, 6, 5}};
    EXPECT_EQ(stitch(mesh, 0.0), (std::vector<int>{0, 1, 2, 3, 1, 5, 6, 2}));
    EXPECT_EQ(mesh.polygons, (Polygons{{0, 3, 2, 1}, {1, 2, 6, 5}}));
}

TEST(Stitch, LeavesLayersAndPointsThatTouchApart)
{
    ObjMesh layers; // two equal squares on each other, and one that touches a corner
    layers.positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 1}, {0, 0, 1}, {0, 0, 0}, {1, 0, 0},
                        {1, 0, 1}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 2}, {1, 0, 2}};
    layers.polygons = {{0, 3, 2, 1}, {4, 5, 6, 7}, {8, 11, 10, 9}};
    const Polygons before = layers.polygons;
    stitch(layers, 0.0);
    EXPECT_EQ(layers.polygons, before);

    ObjMesh three = loose_squares(1); // a third square at the seam of two
    three.positions.insert(three.positions.end(), {{0, 0, 0},
                                                   {0.1, 0, 0},
                                                   {0.1, 0, -0.1},
                                                   {0, 0, -0.1}, //
                                                   {0, 0, 0},
                                                   {0.1, 0, 0},
                                                   {0.1, 0.1, 0},
                                                   {0, 0.1, 0}});
    three.polygons.push_back({4, 5, 6, 7});
    three.polygons.push_back({8, 9, 10, 11});
    const Polygons apart = three.polygons;
    stitch(three, 0.0);
    EXPECT_EQ(three.polygons, apart);
}

TEST(DropRepeatedPolygons, KeepsEachOnceWithItsTextureAndLine)
{
    ObjMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.texture_coordinates = {{0, 0}, {1, 0}, {0, 1}, {1, 1}};
    mesh.polygons = {{0, 1, 2}, {2, 1, 0}, {1, 3, 2}, {1, 2, 0}};
    mesh.polygon_uvs = mesh.polygons;
    mesh.polygon_lines = {11, 12, 13, 14};
    EXPECT_EQ(drop_repeated_polygons(mesh), 2);
    EXPECT_EQ(mesh.polygons, (Polygons{{0, 1, 2}, {1, 3, 2}}));
    EXPECT_EQ(mesh.polygon_uvs, mesh.polygons);
    EXPECT_EQ(mesh.polygon_lines, (std::vector<int>{11, 13}));
}

TEST(DropRepeatedPolygons, KeepsGroups)
{
    ObjMesh mesh;
    mesh.positions.resize(5, Vec3::Zero());
    mesh.polygons = {{0, 1, 2}, {2, 1, 0}, {1, 2, 3}, {0, 1, 2}, {2, 3, 4}, {4, 3, 2}};
    mesh.groups = {{0, "front"}, {1, "its back"}, {2, "side"}, {3, "side again"}, {5, "end"}};
    EXPECT_EQ(drop_repeated_polygons(mesh), 3);
    EXPECT_EQ(mesh.polygons, (Polygons{{0, 1, 2}, {1, 2, 3}, {2, 3, 4}}));
    EXPECT_EQ(mesh.groups, (std::vector<ObjGroup>{{0, "front"}, {1, "side"}, {2, "side again"}}));
}

TEST(DropRepeatedLines, KeepsEachOnceInItsDirection)
{
    ObjMesh mesh;
    mesh.lines = {{3, 1}, {0, 2}, {1, 3}, {3, 1}, {0, 1}};
    drop_repeated_lines(mesh);
    EXPECT_EQ(mesh.lines, (std::vector<std::array<int, 2>>{{3, 1}, {0, 2}, {0, 1}}));
}

TEST(DropLooseVertices, KeepsTheOrderOfTheOthers)
{
    ObjMesh mesh;
    mesh.positions = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {8, 8, 8}, {0, 1, 0}};
    mesh.polygons = {{4, 1, 2}};
    EXPECT_EQ(drop_loose_vertices(mesh), (std::vector<int>{-1, 0, 1, -1, 2}));
    EXPECT_EQ(mesh.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.polygons, (Polygons{{2, 0, 1}}));
}

} // namespace
} // namespace toile::test
