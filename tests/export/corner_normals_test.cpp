#include "export/corner_normals.h"

#include <gtest/gtest.h>

#include "tests/export/export_fixtures.h"

namespace toile::test {

namespace {

/// Two squares that meet at a right angle along the Y axis: one towards +X, one towards +Z.
ObjMesh corner_mesh()
{
    ObjMesh mesh;
    mesh.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 1}, {0, 1, 1}};
    mesh.polygons = {{0, 2, 3, 1}, {0, 1, 5, 4}};
    return mesh;
}

TEST(CornerNormals, AreMeansOverTheFacesOfAVertex)
{
    const ObjMesh mesh = corner_mesh();
    const CornerNormals normals(mesh);
    const std::vector<Vec3> at = normals.at(mesh.positions);
    EXPECT_EQ(at.size(), 6u);
    EXPECT_EQ(normals.indices()[0][0], normals.indices()[1][0]);
    EXPECT_NEAR((at[size_t(normals.indices()[0][0])] - Vec3(1, 0, 1).normalized()).norm(), 0.0, 1e-15);
    EXPECT_NEAR((at[size_t(normals.indices()[0][1])] - Vec3(0, 0, 1)).norm(), 0.0, 1e-15);
}

TEST(CornerNormals, AreCreasedWhereTheTextureIsCut)
{
    ObjMesh mesh = corner_mesh();
    mesh.texture_coordinates.resize(8);
    mesh.polygon_uvs = {{0, 1, 2, 3}, {4, 5, 6, 7}};
    const CornerNormals normals(mesh);
    const std::vector<Vec3> at = normals.at(mesh.positions);
    EXPECT_EQ(at.size(), 8u);
    EXPECT_EQ(at[size_t(normals.indices()[0][0])], Vec3(0, 0, 1));
    EXPECT_EQ(at[size_t(normals.indices()[1][0])], Vec3(1, 0, 0));
}

TEST(CornerNormals, AreZeroWithoutArea)
{
    ObjMesh mesh = corner_mesh();
    mesh.positions.assign(6, Vec3(1, 2, 3));
    for (const Vec3& normal : CornerNormals(mesh).at(mesh.positions))
        EXPECT_EQ(normal, Vec3(0, 0, 0));
}

} // namespace
} // namespace toile::test
