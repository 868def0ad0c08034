#include "export/mesh/mesh_part.h"

#include <gmock/gmock.h>

#include "tests/export/export_fixtures.h"

namespace toile::test {

namespace {

using testing::ElementsAre;

TEST(MeshPart, IsAGroupWithItsVerticesAndTexture)
{
    ObjMesh mesh = quad_mesh(); // two quads 0 1 4 3 and 1 2 5 4, and the triangle 3 4 6
    mesh.groups = {{0, "front"}, {1, "back"}, {2, "front"}};
    const std::vector<MeshPart> parts = parts_of(mesh);
    ASSERT_EQ(parts.size(), 2u);
    EXPECT_EQ(parts[0].name, "front");
    EXPECT_THAT(parts[0].vertices, ElementsAre(0, 1, 3, 4, 6));
    EXPECT_THAT(parts[0].faces.polygons, ElementsAre(ElementsAre(0, 1, 3, 2), ElementsAre(2, 3, 4)));
    EXPECT_EQ(parts[0].faces.texture_coordinates[size_t(parts[0].faces.polygon_uvs[1][1])], Vec2(0.5, 0.5));
    EXPECT_THAT(parts[1].vertices, ElementsAre(1, 2, 4, 5));
    EXPECT_THAT(parts[1].faces.polygons, ElementsAre(ElementsAre(0, 1, 3, 2)));
}

TEST(MeshPart, IsTheWholeMeshWithoutGroups)
{
    const std::vector<MeshPart> parts = parts_of(quad_mesh());
    ASSERT_EQ(parts.size(), 1u);
    EXPECT_EQ(parts[0].name, "other");
    EXPECT_EQ(parts[0].vertices.size(), 7u);
}

} // namespace
} // namespace toile::test
