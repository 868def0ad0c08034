#include <thread>

#include "core/quadrature/tables/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/core/compute/cuda/on_device.h"

/// Worlds on GPUs, each in a separate thread, as `toile simulate --devices` runs them.
namespace toile::test {

using namespace scenes;

namespace {

Scene falling_on(const std::string& avatar)
{
    return parse_scene(R"({"toile": 1, "fps": 30, "frames": 10, "avatars": [)" + avatar + R"(],
        "cloths": [
          {"name": "lower", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02}, "translate": [0, 0.105, 0]},
          {"name": "upper", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02}, "translate": [0.01, 0.112, 0.02]}]})",
                       "test.json");
}

struct Ran {
    int device = -1;
    std::vector<Vec3> positions; ///< at the end
};

Ran run_on(int device, const Scene& scene, const std::shared_ptr<TableStore>& tables)
{
    WorldOptions options;
    options.backend = Backend::Cuda;
    options.device = device;
    options.tables = tables;
    World world(scene, options);
    world.prepare();
    while (world.frame() + 1 < scene.frames)
        EXPECT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    Ran ran{world.device()->index, {}};
    for (const ClothState& cloth : world.cloths())
        ran.positions.insert(ran.positions.end(), cloth.positions.begin(), cloth.positions.end());
    return ran;
}

class ScenesAtOnceTest : public OnDevice {
protected:
    /// Runs one scene in another thread beside a second one in this, twice. Expects the results of each alone
    /// on device 0.
    void expect_as_alone(int ball_device, int figure_device) const
    {
        const auto new_store = [] { return std::make_shared<TableStore>(); };
        const std::vector<Vec3> ball_alone = run_on(0, ball_, new_store()).positions;
        const std::vector<Vec3> figure_alone = run_on(0, figure_, new_store()).positions;
        for (int repeat = 0; repeat < 2; ++repeat) {
            const auto shared = new_store();
            Ran ball, figure;
            {
                const std::jthread other([&] { ball = run_on(ball_device, ball_, shared); });
                figure = run_on(figure_device, figure_, shared);
            }
            EXPECT_EQ(ball.device, ball_device);
            EXPECT_EQ(figure.device, figure_device);
            EXPECT_EQ(ball.positions, ball_alone) << repeat;
            EXPECT_EQ(figure.positions, figure_alone) << repeat;
        }
    }

private:
    Scene ball_ = falling_on(R"({"name": "ball", "sphere": {"radius": 0.1}})");
    Scene figure_ =
        falling_on(R"({"name": "figure", "mannequin": {}, "clip": "walk", "translate": [0, -1.68, 0]})");
};

TEST_F(ScenesAtOnceTest, HaveTheBitsOfSeparateRunsOnOneDevice) { expect_as_alone(0, 0); }

TEST_F(ScenesAtOnceTest, HaveTheBitsOfSeparateRunsOnTwoDevices)
{
    if (cuda_devices().size() < 2)
        GTEST_SKIP() << "this machine has one CUDA device";
    expect_as_alone(1, 0);
    expect_as_alone(0, 1);
}

} // namespace
} // namespace toile::test
