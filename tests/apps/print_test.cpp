#include <gtest/gtest.h>

#include "apps/toile/render/print.h"

namespace toile::test {

using namespace app;

namespace {

/// Square of 0.2 m whose texture is a square of 4 units.
scenes::ClothState square()
{
    scenes::ClothState state;
    state.rest.positions = {{0, 0, 0}, {0.2, 0, 0}, {0.2, 0.2, 0}, {0, 0.2, 0}};
    state.rest.texture_coordinates = {Vec2(0, 0), Vec2(4, 0), Vec2(4, 4), Vec2(0, 4)};
    state.rest.polygons = state.rest.polygon_uvs = {{0, 1, 2, 3}};
    state.triangles = state.rest.triangulated().triangles;
    return state;
}

scene::Cloth printed()
{
    scene::Cloth cloth;
    cloth.shape = std::filesystem::path("square.obj");
    cloth.print = scene::Print::Checker;
    return cloth;
}

TEST(Print, HasTheSizeOfTheClothInItsTexture)
{
    preview::RenderMesh mesh;
    apply_print(printed(), square(), mesh);
    EXPECT_EQ(mesh.material.print, preview::Print::Checker);
    ASSERT_EQ(mesh.corner_coordinates.size(), 2u);
    EXPECT_NEAR((mesh.corner_coordinates[1][1] - Vec2(0.2, 0.2)).norm(), 0.0, 1e-15);
}

TEST(Print, LiesOnPanelsWhereTheyAreTheRestShape)
{
    scenes::ClothState state = square();
    state.panels = {{Vec2(0, 0), Vec2(0.3, 0), Vec2(0.3, 0.3)}, {Vec2(7, 0), Vec2(7.3, 0.3), Vec2(7, 0.3)}};
    preview::RenderMesh mesh;
    apply_print(printed(), state, mesh);
    EXPECT_EQ(mesh.corner_coordinates, state.panels);
}

TEST(Print, LiesOnTheClothAsItWasCutWhereItsRestIsAnother)
{
    scene::Cloth gathered = printed();
    gathered.rest_file = "rest.obj";
    scenes::ClothState state = square();
    state.panels = {{Vec2(0, 0), Vec2(0.1, 0), Vec2(0.1, 0.2)}, {Vec2(0, 0), Vec2(0.1, 0.2), Vec2(0, 0.2)}};
    preview::RenderMesh mesh;
    apply_print(gathered, state, mesh);
    ASSERT_EQ(mesh.corner_coordinates.size(), 2u);
    EXPECT_NEAR((mesh.corner_coordinates[1][1] - Vec2(0.2, 0.2)).norm(), 0.0, 1e-15);

    state.rest.polygon_uvs.clear();
    apply_print(gathered, state, mesh);
    EXPECT_EQ(mesh.corner_coordinates, state.panels);
}

TEST(Print, NeedsTextureCoordinates)
{
    scenes::ClothState state = square();
    state.rest.polygon_uvs.clear();
    preview::RenderMesh mesh;
    apply_print(printed(), state, mesh);
    EXPECT_EQ(mesh.material.print, preview::Print::Plain);
    EXPECT_TRUE(mesh.corner_coordinates.empty());
}

} // namespace
} // namespace toile::test
