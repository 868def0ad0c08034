#include "tests/apps/preview/render_fixtures.h"

namespace toile::test {

using namespace preview;

namespace {

using RenderExample = RenderFileTest;

// Shown in docs/guide/pictures.md.
TEST_F(RenderExample, TakesAPictureAndASheetOfFrames)
{
    RenderMesh skirt = unit_sphere(32);
    const std::vector<std::vector<Vec3>> frames(4, skirt.positions);

    // [docs]
    RenderScene scene;
    skirt.material = cloth_material(Vec3(0.55, 0.09, 0.10));
    scene.meshes = {skirt};
    scene.ground_height = -1.0;

    Renderer renderer(scene, {.width = 160, .height = 120});
    const Camera camera = fit_camera(renderer.points(), {.azimuth_deg = 30.0}, 160.0 / 120.0);
    write_png(file("first.png"), renderer.render(camera));

    std::vector<Image> pictures;
    for (const std::vector<Vec3>& positions : frames) {
        renderer.update(0, positions);
        pictures.push_back(renderer.render(camera));
    }
    write_png(file("sheet.png"), contact_sheet(pictures, 2, std::vector<int>{0, 1, 2, 3}));
    // [docs]
    EXPECT_GT(std::filesystem::file_size(file("first.png")), 1000u);
    EXPECT_GT(std::filesystem::file_size(file("sheet.png")), std::filesystem::file_size(file("first.png")));
}

} // namespace
} // namespace toile::test
