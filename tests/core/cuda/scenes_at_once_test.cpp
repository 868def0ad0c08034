#include <thread>

#include "core/quadrature/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world.h"
#include "tests/core/cuda/on_device.h"

/// Worlds on GPUs, each in a thread of its own, as `toile simulate --devices` runs them.
namespace toile::test {
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
    /// Runs one scene in another thread beside a second one here, twice, and expects what each is alone on
    /// device 0.
    void expect_as_alone(int device_there, int device_here) const
    {
        const auto own = [] { return std::make_shared<TableStore>(); };
        const std::vector<Vec3> alone_there = run_on(0, there_, own()).positions;
        const std::vector<Vec3> alone_here = run_on(0, here_, own()).positions;
        for (int turn = 0; turn < 2; ++turn) {
            const auto shared = own();
            Ran there, here;
            {
                const std::jthread other([&] { there = run_on(device_there, there_, shared); });
                here = run_on(device_here, here_, shared);
            }
            EXPECT_EQ(there.device, device_there);
            EXPECT_EQ(here.device, device_here);
            EXPECT_EQ(there.positions, alone_there) << turn;
            EXPECT_EQ(here.positions, alone_here) << turn;
        }
    }

private:
    Scene there_ = falling_on(R"({"name": "ball", "sphere": {"radius": 0.1}})");
    Scene here_ =
        falling_on(R"({"name": "figure", "mannequin": {}, "clip": "walk", "translate": [0, -1.68, 0]})");
};

TEST_F(ScenesAtOnceTest, HaveTheBitsOfEachAloneOnOneDevice) { expect_as_alone(0, 0); }

TEST_F(ScenesAtOnceTest, HaveTheBitsOfEachAloneOnTwoDevices)
{
    if (cuda_devices().size() < 2)
        GTEST_SKIP() << "this machine has one CUDA device";
    expect_as_alone(1, 0);
    expect_as_alone(0, 1);
}

} // namespace
} // namespace toile::test
