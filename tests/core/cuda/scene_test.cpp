#include "scenes/world.h"

#include <algorithm>

#include "core/quadrature/table_store.h"
#include "scenes/format/read_scene.h"
#include "scenes/world_crossings.h"
#include "tests/core/cuda/on_device.h"

/// Whole scenes on a GPU against the same on the CPU, with quadrature on both.
namespace toile::test {
namespace {

Scene scene_of(const std::string& keys) { return parse_scene("{\"toile\": 1, " + keys + "}", "test.json"); }

World world_on(Backend backend, const Scene& scene)
{
    WorldOptions options;
    options.backend = backend;
    options.tables = std::make_shared<TableStore>();
    return World(scene, options);
}

double farthest_apart(const World& a, const World& b)
{
    double most = 0.0;
    for (int c = 0; c < a.cloths().size(); ++c)
        for (size_t v = 0; v < a.cloths()[c].positions.size(); ++v)
            if (const double apart = (a.cloths()[c].positions[v] - b.cloths()[c].positions[v]).norm();
                !(apart <= most)) // NaN is kept too
                most = apart;
    return most;
}

/// Steps that end by their tolerance, small enough that both backends end at the same place.
const std::string kExact = R"("fps": 60, "solver": {"method": "quadrature", "tolerance": 1e-6,
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
    World here = world_on(Backend::Cpu, scene), there = world_on(Backend::Cuda, scene);
    ASSERT_NE(there.device(), nullptr);
    for (int frame = 1; frame <= 3; ++frame) {
        here.advance_frame();
        there.advance_frame();
        EXPECT_LT(farthest_apart(here, there), 2e-5 * frame) << frame;
    }
    EXPECT_EQ(there.stages().calls("garment/membrane"), 0);
    EXPECT_EQ(there.stages().calls("pd/pcg"), 0);
    EXPECT_EQ(there.stages().calls("contact/make_there"), 0);
}

/// Wind, gusts, what is held and moves, strain limits, sleep: what a step needs of them is on the GPU.
TEST_F(DeviceSceneTest, CopiesPositionsOnlyWhenTheyAreAskedFor)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 20, "contact": {"self": false},
        "solver": {"method": "quadrature", "substeps": 2},
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
    EXPECT_EQ(farthest_apart(world, again), 0.0) << "whoever looked";
}

/// They are read when the scene has long gone on.
TEST_F(DeviceSceneTest, SnapshotsAreNotWaitedForAndStay)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 9, )" + kTwoSheetsOnABall);
    World world = world_on(Backend::Cuda, scene), watched = world_on(Backend::Cuda, scene);
    std::vector<std::shared_ptr<const Snapshot>> snapshots{world.snapshot()};
    std::vector<std::vector<ClothState>> seen{{watched.cloths().begin(), watched.cloths().end()}};
    for (int frame = 1; frame < 9; ++frame) {
        world.advance_frame();
        snapshots.push_back(world.snapshot());
        watched.advance_frame();
        seen.emplace_back(watched.cloths().begin(), watched.cloths().end());
    }
    EXPECT_LT(world.stages().calls("cuda/to_host"), watched.stages().calls("cuda/to_host"));
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
    World here = world_on(Backend::Cpu, scene), there = world_on(Backend::Cuda, scene);
    for (World* world : {&here, &there}) {
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

/// Until they wrinkle: from the third frame on two minimisers of nearly the same energy lie 2 mm apart, and
/// which is found depends on the tolerance on the CPU too.
TEST_F(DeviceSceneTest, LandsOnABallAsOnTheCpu)
{
    const Scene scene = scene_of(kExact + R"("frames": 12, )" + kTwoSheetsOnABall);
    World here = world_on(Backend::Cpu, scene), there = world_on(Backend::Cuda, scene);
    int contacts = 0;
    for (int frame = 1; frame <= 2; ++frame) {
        const StepReport expected = here.advance_frame(), report = there.advance_frame();
        contacts = expected.contacts;
        EXPECT_NEAR(report.contacts, contacts, 2 + 0.2 * contacts) << frame;
        EXPECT_LT(farthest_apart(here, there), 3e-4) << frame;
    }
    EXPECT_GT(contacts, 2);
    EXPECT_GT(there.stages().calls("pd/pcg"), 0);
}

TEST_F(DeviceSceneTest, NeverCrossesAndHasTheSameBitsEveryTime)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 16, )" + kTwoSheetsOnABall);
    World first = world_on(Backend::Cuda, scene), second = world_on(Backend::Cuda, scene);
    for (int frame = 1; frame < 16; ++frame) {
        EXPECT_NE(first.advance_frame().status, StepReport::Status::NonFinite);
        second.advance_frame();
        EXPECT_EQ(crossing_count(first), 0) << frame;
        EXPECT_EQ(farthest_apart(first, second), 0.0) << frame;
    }
}

TEST_F(DeviceSceneTest, KeepsStrainLimits)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 16,
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.6, 0.6], "resolution": 0.02}, "rotate_deg": [90, 0, 0]}],
        "attachments": [{"cloth": "sheet", "select": {"nearest": [[-0.3, 0.3, 0], [0.3, 0.3, 0]]}}])");
    World here = world_on(Backend::Cpu, scene), there = world_on(Backend::Cuda, scene);
    double expected = 0.0, strain = 0.0;
    for (int frame = 1; frame < 16; ++frame) {
        expected = std::max(expected, here.advance_frame().max_strain);
        strain = std::max(strain, there.advance_frame().max_strain);
    }
    EXPECT_LT(strain, expected + 0.01);
    EXPECT_GT(here.stages().calls("garment/strain_limit"), 0);
    EXPECT_GT(there.stages().calls("garment/strain_limit"), 0);
}

/// A mesh that moves, whose sides are remembered and that cloth strays on.
TEST_F(DeviceSceneTest, DressesAWalkingFigureAsOnTheCpu)
{
    const Scene scene = scene_of(R"("fps": 30, "frames": 20, "solver": {"method": "quadrature"},
        "avatars": [{"name": "mannequin", "mannequin": {}, "clip": "walk", "preroll": {"ease": 0.2, "from_bind": true}}],
        "cloths": [{"name": "skirt", "fabric": "denim", "translate": [0, 1.08, 0],
          "skirt": {"waist_radius": 0.14, "hem_radius": 0.24, "length": 0.55, "resolution": 0.03}}],
        "attachments": [{"cloth": "skirt", "to": "mannequin",
          "select": {"box": {"lower": [-0.5, 1.07, -0.5], "upper": [0.5, 1.1, 0.5]}}}])");
    World here = world_on(Backend::Cpu, scene), there = world_on(Backend::Cuda, scene);
    int contacts = 0, found = 0;
    for (int frame = 1; frame < 20; ++frame) {
        contacts += here.advance_frame().contacts;
        const StepReport report = there.advance_frame();
        EXPECT_NE(report.status, StepReport::Status::NonFinite);
        found += report.contacts;
        EXPECT_LT(farthest_apart(here, there), 0.05) << frame; // folds differ, the skirt does not
        EXPECT_EQ(crossing_count(there), 0) << frame;
    }
    EXPECT_GT(contacts, 100);
    EXPECT_NEAR(found, contacts, 0.3 * contacts);
    EXPECT_GT(there.stages().calls("collision/detect_there"), 0);
    EXPECT_LT(there.stages().calls("collision/detect"), 2 * here.stages().calls("collision/detect"));
    EXPECT_GT(here.stages().calls("collision/refit"), 0);
    EXPECT_EQ(there.stages().calls("collision/refit"), 0)
        << "nobody on the host asks where the figure is near";
    EXPECT_EQ(there.stages().calls("avatars/skin"), 0) << "nor where it is";
    EXPECT_GT(there.stages().calls("avatars/device_skin"), 0);
}

} // namespace
} // namespace toile::test
