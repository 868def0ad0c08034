#include "scenes/world/world.h"

#include <algorithm>

#include "collision/check/penetration.h"
#include "core/quadrature/tables/table_store.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world_crossings.h"
#include "tests/core/compute/cuda/on_device.h"

/// Whole scenes on a GPU compared with the CPU, with quadrature on both.
namespace toile::test {

using namespace collision;
using namespace scenes;

namespace {

Scene scene_of(const std::string& keys) { return parse_scene("{\"toile\": 1, " + keys + "}", "test.json"); }

World world_on(Backend backend, const Scene& scene)
{
    WorldOptions options;
    options.backend = backend;
    options.tables = std::make_shared<TableStore>();
    return World(scene, options);
}

double max_distance(const World& a, const World& b)
{
    double max = 0.0;
    for (int c = 0; c < a.cloths().size(); ++c)
        for (size_t v = 0; v < a.cloths()[c].positions.size(); ++v)
            if (const double apart = (a.cloths()[c].positions[v] - b.cloths()[c].positions[v]).norm();
                !(apart <= max)) // true for NaN too
                max = apart;
    return max;
}

/// Tolerance small enough that both backends end at the same solution.
const std::string kExact =
    R"("fps": 60, "solver": {"method": "quadrature", "outer": "lbfgs", "velocity_tolerance": 1.2e-4,
    "max_iterations": 400, "substeps": 2, "sleep": {"enabled": false}}, )";

const std::string kTwoSheetsOnABall = R"("avatars": [{"name": "ball", "sphere": {"radius": 0.1}}],
    "cloths": [
      {"name": "lower", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02}, "translate": [0, 0.105, 0]},
      {"name": "upper", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02}, "translate": [0.01, 0.112, 0.02]}])";

class DeviceSceneTest : public OnDevice {};

TEST_F(DeviceSceneTest, SwingsInTheWindAsOnTheCpu)
{
    const Scene scene = scene_of(kExact + R"("frames": 12, "contact": {"self": false},
        "wind": {"velocity": [1, 0, 0.5], "turbulence": 0.4},
        "cloths": [{"name": "flag", "rectangle": {"size": [0.4, 0.3], "resolution": 0.02}}],
        "attachments": [{"cloth": "flag", "select": {"nearest": [[-0.2, 0, -0.15], [-0.2, 0, 0.15]]}}])");
    World cpu = world_on(Backend::Cpu, scene), gpu = world_on(Backend::Cuda, scene);
    ASSERT_NE(gpu.device(), nullptr);
    for (int frame = 1; frame <= 3; ++frame) {
        cpu.advance_frame();
        gpu.advance_frame();
        EXPECT_LT(max_distance(cpu, gpu), 2e-5 * frame) << frame;
    }
    EXPECT_EQ(gpu.stages().calls("garment/membrane"), 0);
    EXPECT_EQ(gpu.stages().calls("pd/pcg"), 0);
    EXPECT_EQ(gpu.stages().calls("contact/make_on_device"), 0);
}

/// With wind, gusts, moving attachments, strain limits and sleep, all inputs of a step are on the GPU.
TEST_F(DeviceSceneTest, CopiesPositionsOnlyOnRequest)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 20, "contact": {"self": false},
        "solver": {"method": "quadrature", "quality": "preview", "substeps": 2},
        "wind": {"velocity": [3, 0, 0.5], "turbulence": 0.4},
        "cloths": [{"name": "flag", "rectangle": {"size": [0.4, 0.3], "resolution": 0.02}},
                   {"name": "other", "rectangle": {"size": [0.2, 0.2], "resolution": 0.02}, "translate": [0, 1, 0]}],
        "attachments": [{"cloth": "flag", "select": {"nearest": [[-0.2, 0, -0.15], [-0.2, 0, 0.15]]},
                         "keyframes": [{"time": 0}, {"time": 0.5, "translate": [0, 0.1, 0]}]}])");
    World world = world_on(Backend::Cuda, scene);
    world.advance_frame();
    const std::vector<Vec3> before = world.cloths()[0].positions;
    const auto copies = [&] { return world.stages().calls("cuda/to_host"); };
    const long at_first = copies();
    for (int frame = 0; frame < 5; ++frame)
        EXPECT_GT(world.advance_frame().max_strain, 0.0);
    EXPECT_EQ(copies(), at_first);
    EXPECT_GT((world.cloths()[0].positions[0] - before[0]).norm(), 0.0);
    EXPECT_GT(copies(), at_first);

    World again = world_on(Backend::Cuda, scene);
    while (again.frame() < world.frame())
        again.advance_frame();
    EXPECT_EQ(max_distance(world, again), 0.0) << "whoever looked";
}

/// Snapshots are read long after the scene has advanced.
TEST_F(DeviceSceneTest, SnapshotsAreAsynchronousAndPersist)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 9, )" + kTwoSheetsOnABall);
    World world = world_on(Backend::Cuda, scene), observed = world_on(Backend::Cuda, scene);
    std::vector<std::shared_ptr<const Snapshot>> snapshots{world.snapshot()};
    std::vector<std::vector<ClothState>> seen{{observed.cloths().begin(), observed.cloths().end()}};
    for (int frame = 1; frame < 9; ++frame) {
        world.advance_frame();
        snapshots.push_back(world.snapshot());
        observed.advance_frame();
        seen.emplace_back(observed.cloths().begin(), observed.cloths().end());
    }
    EXPECT_LT(world.stages().calls("cuda/to_host"), observed.stages().calls("cuda/to_host"));
    for (int frame = 0; frame < 9; ++frame)
        for (int c = 0; c < 2; ++c) {
            const View<const Vec3> x = snapshots[frame]->positions(c);
            EXPECT_EQ(std::vector<Vec3>(x.begin(), x.end()), seen[frame][c].positions) << frame;
        }
}

TEST_F(DeviceSceneTest, SleepsAsOnTheCpu)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 90, "contact": {"self": false},
        "fabrics": {"slow": {"base": "cotton", "damping": 20}},
        "avatars": [{"name": "floor", "plane": {}}],
        "cloths": [{"name": "rug", "fabric": "slow", "rectangle": {"size": [0.2, 0.2], "resolution": 0.05}, "translate": [0, 0.004, 0]}])");
    World cpu = world_on(Backend::Cpu, scene), gpu = world_on(Backend::Cuda, scene);
    for (World* world : {&cpu, &gpu}) {
        const auto steps = [&] { return world->stages().calls("pd/minimise"); };
        world->advance_frame();
        EXPECT_GT(steps(), 0);
        while (world->frame() < 80)
            world->advance_frame();
        const long so_far = steps();
        world->advance_frame();
        EXPECT_EQ(steps(), so_far);
    }
}

/// The comparison ends before the cloth wrinkles. From the third frame on two minimisers of nearly the same
/// energy lie 2 mm apart; on the CPU, too, the tolerance decides which is found.
TEST_F(DeviceSceneTest, LandsOnABallAsOnTheCpu)
{
    const Scene scene = scene_of(kExact + R"("frames": 12, )" + kTwoSheetsOnABall);
    World cpu = world_on(Backend::Cpu, scene), gpu = world_on(Backend::Cuda, scene);
    int contacts = 0;
    for (int frame = 1; frame <= 2; ++frame) {
        const StepReport expected = cpu.advance_frame(), report = gpu.advance_frame();
        contacts = expected.contacts;
        EXPECT_NEAR(report.contacts, contacts, 2 + 0.2 * contacts) << frame;
        EXPECT_LT(max_distance(cpu, gpu), 3e-4) << frame;
    }
    EXPECT_GT(contacts, 2);
    EXPECT_GT(gpu.stages().calls("pd/pcg"), 0);
}

TEST_F(DeviceSceneTest, NeverCrossesAndHasTheSameBitsEveryTime)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 16, )" + kTwoSheetsOnABall);
    World first = world_on(Backend::Cuda, scene), second = world_on(Backend::Cuda, scene);
    for (int frame = 1; frame < 16; ++frame) {
        EXPECT_NE(first.advance_frame().status, StepReport::Status::NonFinite);
        second.advance_frame();
        EXPECT_EQ(crossing_count(first), 0) << frame;
        EXPECT_EQ(max_distance(first, second), 0.0) << frame;
    }
}

/// Newton's method has the limit as an energy; projections are those of previews.
TEST_F(DeviceSceneTest, KeepsStrainLimits)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 16, "solver": {"quality": "preview"},
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.6, 0.6], "resolution": 0.02}, "rotate_deg": [90, 0, 0]}],
        "attachments": [{"cloth": "sheet", "select": {"nearest": [[-0.3, 0.3, 0], [0.3, 0.3, 0]]}}])");
    World cpu = world_on(Backend::Cpu, scene), gpu = world_on(Backend::Cuda, scene);
    double expected = 0.0, strain = 0.0;
    for (int frame = 1; frame < 16; ++frame) {
        expected = std::max(expected, cpu.advance_frame().max_strain);
        strain = std::max(strain, gpu.advance_frame().max_strain);
    }
    EXPECT_LT(strain, expected + 0.01);
    EXPECT_GT(gpu.stages().calls("garment/strain_limit"), 0);
}

/// An arm that goes through a curtain; kept off bodies by the collision-free step.
TEST_F(DeviceSceneTest, CarriesACurtainAlongWithAnArm)
{
    for (const double speed : {5.0, 15.0}) {
        const Scene scene = scene_of(R"("frames": 16, "avatars": [{"name": "arm", "rotate_deg": [0, 0, 90],
            "translate": [0, 0.6, 0.3], "keyframes": [{"time": 0.2}, {"time": )" +
                                     std::to_string(0.2 + 0.6 / speed) + R"(, "translate": [0, 0, -0.6]}],
            "capsule": {"radius": 0.04, "length": 0.8}}],
            "cloths": [{"name": "curtain", "rectangle": {"size": [0.8, 1], "resolution": 0.04},
            "rotate_deg": [90, 0, 0], "translate": [0, 0.6, 0]}], "attachments": [{"cloth": "curtain",
            "select": {"box": {"lower": [-1, 1.08, -1], "upper": [1, 1.2, 1]}}}])");
        World gpu = world_on(Backend::Cuda, scene);
        std::vector<SceneBody> bodies = make_bodies(scene);
        double depth = 0.0;
        for (int frame = 1; frame < 16; ++frame) {
            EXPECT_NE(gpu.advance_frame().status, StepReport::Status::NonFinite);
            bodies[0].advance_to(frame * scene.frame_duration());
            const ClothState& cloth = gpu.cloths()[0];
            for (const Triangle& t : cloth.triangles)
                depth = std::max(depth, penetration_of_triangle(*bodies[0].shape(), bodies[0].pose(),
                                                                cloth.positions[t[0]], cloth.positions[t[1]],
                                                                cloth.positions[t[2]]));
            EXPECT_EQ(crossing_count(gpu), 0) << frame;
        }
        EXPECT_LT(depth, 1e-3) << speed << " m/s";
        EXPECT_GT(gpu.stages().calls("collision/carry"), 0);
    }
}

TEST_F(DeviceSceneTest, SaysThatABodyHasJumpedThroughCloth)
{
    const Scene scene = scene_of(R"("frames": 16, "avatars": [{"name": "arm", "rotate_deg": [0, 0, 90],
        "translate": [0, 0.6, 0.3], "keyframes": [{"time": 0.3}, {"time": 0.3012, "translate": [0, 0, -0.6]}],
        "capsule": {"radius": 0.04, "length": 0.8}}],
        "cloths": [{"name": "curtain", "rectangle": {"size": [0.8, 1], "resolution": 0.04},
        "rotate_deg": [90, 0, 0], "translate": [0, 0.6, 0]}], "attachments": [{"cloth": "curtain",
        "select": {"box": {"lower": [-1, 1.08, -1], "upper": [1, 1.2, 1]}}}])");
    World gpu = world_on(Backend::Cuda, scene);
    StepReport::Status worst = StepReport::Status::Converged;
    for (int frame = 1; frame < 16; ++frame)
        worst = std::max(worst, gpu.advance_frame().status);
    EXPECT_EQ(worst, StepReport::Status::Stuck);
}

/// A moving mesh with remembered sides, and cloth vertices out of bounds on it.
TEST_F(DeviceSceneTest, DressesAWalkingMannequinAsOnTheCpu)
{
    const Scene scene =
        scene_of(R"("fps": 30, "frames": 20, "solver": {"method": "quadrature", "quality": "preview"},
        "avatars": [{"name": "mannequin", "mannequin": {}, "clip": "walk", "preroll": {"ease": 0.2, "from_bind": true}}],
        "cloths": [{"name": "skirt", "fabric": "denim", "translate": [0, 1.08, 0],
          "skirt": {"waist_radius": 0.14, "hem_radius": 0.24, "length": 0.55, "resolution": 0.03}}],
        "attachments": [{"cloth": "skirt", "to": "mannequin",
          "select": {"box": {"lower": [-0.5, 1.07, -0.5], "upper": [0.5, 1.1, 0.5]}}}])");
    World cpu = world_on(Backend::Cpu, scene), gpu = world_on(Backend::Cuda, scene);
    int contacts = 0, found = 0;
    for (int frame = 1; frame < 20; ++frame) {
        contacts += cpu.advance_frame().contacts;
        const StepReport report = gpu.advance_frame();
        EXPECT_NE(report.status, StepReport::Status::NonFinite);
        found += report.contacts;
        EXPECT_LT(max_distance(cpu, gpu), 0.05) << frame; // folds differ, the skirt as a whole does not
        EXPECT_EQ(crossing_count(gpu), 0) << frame;
    }
    EXPECT_GT(contacts, 100);
    EXPECT_NEAR(found, contacts, 0.3 * contacts);
    EXPECT_GT(gpu.stages().calls("collision/detect_on_device"), 0);
    EXPECT_LT(gpu.stages().calls("collision/detect"), 2 * cpu.stages().calls("collision/detect"));
    EXPECT_GT(cpu.stages().calls("collision/refit"), 0);
    EXPECT_EQ(gpu.stages().calls("collision/refit"), 0) << "nobody on the host asks where the figure is near";
    EXPECT_GT(gpu.stages().calls("avatars/device_skin"), 0);
}

} // namespace
} // namespace toile::test
