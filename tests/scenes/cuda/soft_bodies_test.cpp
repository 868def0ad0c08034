#include <algorithm>

#include "core/quadrature/tables/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world_crossings.h"
#include "tests/core/compute/cuda/on_device.h"
#include "tests/support/temporary_folder.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/msh.h"

/// Soft bodies on a GPU compared with the CPU.
namespace toile::test {

using namespace scenes;

namespace {

class DeviceSoftBodiesTest : public OnDevice {
protected:
    DeviceSoftBodiesTest()
    {
        volume::write_msh(folder_.path() / "block.msh", make_block(Vec3::Constant(0.1), {4, 4, 4}, 0.1).mesh);
    }

    World world_on(Backend backend, const std::string& solver, const std::string& keys = "") const
    {
        WorldOptions options;
        options.backend = backend;
        options.tables = std::make_shared<TableStore>();
        return World(parse_scene(R"({"toile": 1, "fps": 60, "frames": 12, "solver": {)" + solver + R"(},
            "avatars": [{"name": "floor", "plane": {}}],
            "soft_bodies": [
              {"name": "a", "file": "block.msh", "young": 2e4, "damping": 0.5, "translate": [0, 0.004, 0]},
              {"name": "b", "file": "block.msh", "young": 2e4, "translate": [0.03, 0.112, 0.02],
               "rotate_deg": [0, 30, 0], "velocity": [0, -0.5, 0]}],
            "cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02},
                        "translate": [0.05, 0.23, 0.05]}])" +
                                     keys + "}",
                                 folder_.path() / "test.json"),
                     options);
    }

private:
    TemporaryFolder folder_;
};

double max_distance(const World& a, const World& b)
{
    double max = 0.0;
    for (int s = 0; s < a.surfaces().size(); ++s)
        for (size_t v = 0; v < a.surfaces()[s].positions.size(); ++v)
            if (const double apart = (a.surfaces()[s].positions[v] - b.surfaces()[s].positions[v]).norm();
                !(apart <= max)) // true for NaN too
                max = apart;
    return max;
}

TEST_F(DeviceSoftBodiesTest, MoveAsOnTheCpu)
{
    const std::string exact = R"("velocity_tolerance": 1e-5, "substeps": 4)";
    const std::string held = R"(, "attachments": [{"cloth": "a", "select": {"nearest": [[0, 0, 0]]}}])";
    World cpu = world_on(Backend::Cpu, exact, held), gpu = world_on(Backend::Cuda, exact, held);
    ASSERT_NE(gpu.device(), nullptr);
    for (int frame = 1; frame <= 4; ++frame) {
        cpu.advance_frame();
        EXPECT_EQ(gpu.advance_frame().unfinished, 0);
        EXPECT_LT(max_distance(cpu, gpu), 2e-5 * frame) << frame;
    }
}

TEST_F(DeviceSoftBodiesTest, PileUpUncrossedWithTheSameBitsEveryTime)
{
    World first = world_on(Backend::Cuda, ""), second = world_on(Backend::Cuda, "");
    for (int frame = 1; frame <= 12; ++frame) {
        first.advance_frame();
        second.advance_frame();
        EXPECT_EQ(crossing_count(first), 0) << frame;
    }
    EXPECT_EQ(max_distance(first, second), 0.0);
}

TEST_F(DeviceSoftBodiesTest, ShareTheTablesOfEqualBodies)
{
    const std::string solver = R"("method": "quadrature", "outer": "lbfgs", "velocity_tolerance": 1.2e-4,
        "max_iterations": 400, "substeps": 4)";
    World cpu = world_on(Backend::Cpu, solver), gpu = world_on(Backend::Cuda, solver);
    for (int frame = 1; frame <= 3; ++frame) {
        cpu.advance_frame();
        gpu.advance_frame();
        EXPECT_LT(max_distance(cpu, gpu), 5e-5 * frame) << frame;
    }
    EXPECT_EQ(gpu.stages().calls("quadrature/build"), 2); // the sheet's, and that of both bodies
}

} // namespace
} // namespace toile::test
