#include <gtest/gtest.h>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Two cloths, one of them held near a ball until 0.5 s, and a solid.
Scene scene_of_three(double height)
{
    return parse_scene(R"({"toile": 1, "frames": 2, "avatars": [{"name": "other", "sphere": {"radius": 0.1},
        "translate": [3, 0, 0]}, {"name": "ball", "sphere": {"radius": 0.2}}],
        "cloths": [{"name": "c", "rectangle": {"size": [0.4, 0.4], "resolution": 0.05}, "translate": [0, )" +
                           std::to_string(height) + R"(, 0]},
        {"name": "d", "disc": {"radius": 0.2, "resolution": 0.05}, "translate": [0, 0.5, 0], "fabric": "denim"}],
        "solids": [{"name": "brick", "box": {"size": [0.1, 0.1, 0.1]}, "density": 100,
        "translate": [0, 0.8, 0]}],
        "attachments": [{"cloth": "c", "select": {"all_within": {"avatar": "ball", "distance": 0.05}},
        "to": "ball", "release": 0.5}, {"cloth": "d", "select": {"vertices": [3, 1]}}]})",
                       "three.json");
}

TEST(LoadSurfaces, AreThoseOfAWorldAtItsStart)
{
    const Scene scene = scene_of_three(0.22);
    const World world(scene);
    const std::vector<ClothState> loaded = load_surfaces(scene);
    ASSERT_EQ(int(loaded.size()), world.surfaces().size());
    ASSERT_FALSE(world.start().was_repaired);
    for (int i = 0; i < int(loaded.size()); ++i) {
        const ClothState &expected = world.surfaces()[i], &found = loaded[size_t(i)];
        EXPECT_EQ(found.name, expected.name);
        EXPECT_EQ(found.positions, expected.positions);
        EXPECT_EQ(found.triangles, expected.triangles);
        EXPECT_EQ(found.rest.positions, expected.rest.positions);
        EXPECT_EQ(found.fabric.strain_limit, expected.fabric.strain_limit);
        for (const double t : {0.0, 1.0})
            EXPECT_EQ(found.attached(t), expected.attached(t)) << found.name << " at " << t;
    }
    EXPECT_GT(loaded[0].attachments.at(0).vertices.size(), 3u);
    EXPECT_EQ(loaded[1].attachments.at(0).vertices, (std::vector<int>{1, 3}));
}

/// Caches are checked where they were written, however their scene starts.
TEST(LoadSurfaces, NeedNoStartThatCanBeRepaired)
{
    const Scene scene = scene_of_three(0.0);
    EXPECT_THROW(World{scene}, InvalidInput);
    EXPECT_EQ(load_surfaces(scene).size(), 3u);
}

TEST(LoadSurfaces, RefuseSelectionsThatDoNotWork)
{
    Scene scene = scene_of_three(0.6);
    EXPECT_THROW(load_surfaces(scene), InvalidInput) << "nothing is near the ball";
    scene = scene_of_three(0.22);
    scene.attachments[1].select.by = std::vector<int>{1000};
    EXPECT_THROW(load_surfaces(scene), InvalidInput);
}

} // namespace
} // namespace toile::test
