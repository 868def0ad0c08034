#include "scenes/world/snapshot.h"

#include <gtest/gtest.h>

#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Cloths without mutual contact are separate groups, cloths in contact are one; solids come last.
TEST(Snapshot, HasAllSurfacesOfItsFrame)
{
    const std::string cloths = R"("cloths": [
        {"name": "a", "rectangle": {"size": [0.2, 0.1], "resolution": 0.05}, "translate": [0, 1, 0]},
        {"name": "b", "rectangle": {"size": [0.1, 0.1], "resolution": 0.05}, "translate": [1, 1, 0]}])";
    for (const char* others :
         {R"(, "contact": {"self": false}})",
          R"(, "solids": [{"name": "brick", "box": {"size": [0.2, 0.1, 0.06]}, "translate": [2, 1, 0]}]})"}) {
        World world(parse_scene(std::string(R"({"toile": 1, "frames": 9, )").append(cloths).append(others),
                                "test.json"));
        world.advance_frame();
        const std::vector<ClothState> then(world.surfaces().begin(), world.surfaces().end());
        const std::shared_ptr<const Snapshot> snapshot = world.snapshot();
        world.advance_frame();
        for (size_t s = 0; s < then.size(); ++s) {
            const View<const Vec3> x = snapshot->positions(int(s));
            EXPECT_EQ(std::vector<Vec3>(x.begin(), x.end()), then[s].positions) << then[s].name;
            EXPECT_NE(world.surfaces()[s].positions, then[s].positions);
        }
    }
}

} // namespace
} // namespace toile::test
