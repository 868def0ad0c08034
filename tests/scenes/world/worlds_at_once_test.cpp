#include <thread>

#include <gtest/gtest.h>

#include "core/quadrature/tables/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

/// Worlds share resources of the process: threads, factors and tables of equal cloths, Embree's device.
namespace toile::test {

using namespace scenes;

namespace {

/// Scene with two equal cloths, so that factor and tables are shared, and the avatar of `keys`.
Scene scene_with(const std::string& method, const std::string& keys)
{
    return parse_scene(R"({"toile": 1, "fps": 30, "frames": 6, "solver": {"method": ")" + method + R"("}, )" +
                           keys + R"(
        "cloths": [
          {"name": "lower", "rectangle": {"size": [0.5, 0.5], "resolution": 0.02}, "translate": [0, 1.9, 0]},
          {"name": "upper", "rectangle": {"size": [0.5, 0.5], "resolution": 0.02}, "translate": [0.01, 1.91, 0.02]}]})",
                       "test.json");
}

std::vector<Vec3> positions_after_run(const Scene& scene, const std::shared_ptr<TableStore>& tables)
{
    WorldOptions options;
    options.tables = tables;
    World world(scene, options);
    world.prepare();
    while (world.frame() + 1 < scene.frames)
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    std::vector<Vec3> positions;
    for (const ClothState& cloth : world.cloths())
        positions.insert(positions.end(), cloth.positions.begin(), cloth.positions.end());
    return positions;
}

TEST(WorldsAtOnce, HaveTheBitsOfSeparateRuns)
{
    const std::string walking =
        R"("avatars": [{"name": "mannequin", "mannequin": {}, "clip": "walk", "translate": [0, 0.1, 0]}], )";
    const std::string ball =
        R"("avatars": [{"name": "ball", "sphere": {"radius": 0.2}, "translate": [0, 1.69, 0]}], )";
    for (const char* method : {"direct", "quadrature"}) {
        const Scene first = scene_with(method, walking), second = scene_with(method, ball);
        const std::vector<Vec3> first_alone = positions_after_run(first, std::make_shared<TableStore>());
        const std::vector<Vec3> second_alone = positions_after_run(second, std::make_shared<TableStore>());

        const auto shared = std::make_shared<TableStore>();
        std::vector<Vec3> first_beside, second_beside;
        {
            const std::jthread other([&] { first_beside = positions_after_run(first, shared); });
            second_beside = positions_after_run(second, shared);
        }
        EXPECT_EQ(first_beside, first_alone) << method;
        EXPECT_EQ(second_beside, second_alone) << method;
    }
}

} // namespace
} // namespace toile::test
