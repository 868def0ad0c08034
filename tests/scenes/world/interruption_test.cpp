#include <gtest/gtest.h>

#include <map>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Cloth that starts 2 cm inside a ball, then settles and falls; one step per sample.
Scene sunk_sheet()
{
    return parse_scene(R"({"toile": 1, "frames": 5, "settle": 0.2, "solver": {"substeps": 1}, "avatars": [
        {"name": "ball", "sphere": {"radius": 0.2}}], "cloths": [{"name": "c", "rectangle": {"size": [0.4, 0.4],
        "resolution": 0.04}, "translate": [0, 0.18, 0]}]})",
                       "sunk.json");
}

/// What a run tells: the last fraction of each task, and how often it asks whether to go on.
struct Told {
    std::map<std::string, double> tasks;
    int asked = 0;
    int allowed = 1 << 30; ///< questions answered with yes

    WorldOptions options()
    {
        WorldOptions options;
        options.progress = [this](const std::string& task, double fraction) {
            EXPECT_GE(fraction, 0.0);
            EXPECT_LE(fraction, 1.0);
            tasks[task] = fraction;
        };
        options.goes_on = [this] { return ++asked <= allowed; };
        return options;
    }
};

TEST(Interruption, EveryLongStageTellsHowFarItIs)
{
    Told told;
    World world(sunk_sheet(), told.options());
    EXPECT_EQ(told.tasks["loading"], 1.0);
    EXPECT_EQ(told.tasks["repair of the start pose"], 1.0);
    const int in_repair = told.asked;
    EXPECT_GT(in_repair, 5);
    world.prepare();
    EXPECT_EQ(told.tasks["preparation of the solvers"], 1.0);
    world.settle();
    EXPECT_EQ(told.tasks["settling"], 1.0);
    const int in_settling = told.asked;
    EXPECT_GT(in_settling, in_repair + 12) << "more than once a step";
    world.advance_frame();
    EXPECT_EQ(told.tasks["steps of a frame"], 1.0);
    EXPECT_EQ(told.tasks.count("step 1, iteration 2"), 1u);
    EXPECT_GT(told.asked, in_settling + 2) << "more than once in one step";
}

TEST(Interruption, EndsEveryStageAtOnce)
{
    Told counted;
    World undisturbed(sunk_sheet(), counted.options());
    const int in_repair = counted.asked;
    undisturbed.settle();
    const int in_settling = counted.asked;
    undisturbed.advance_frame();
    const std::vector<Vec3> sample = undisturbed.cloths()[0].positions;

    for (int allowed = 0; allowed < in_repair; ++allowed) {
        Told told;
        told.allowed = allowed;
        EXPECT_THROW(World(sunk_sheet(), told.options()), Cancelled);
        EXPECT_EQ(told.asked, allowed + 1);
    }

    Told told;
    told.allowed = in_repair;
    World unprepared(sunk_sheet(), told.options());
    EXPECT_THROW(unprepared.prepare(), Cancelled);

    told = {};
    told.allowed = (in_repair + in_settling) / 2;
    World settling(sunk_sheet(), told.options());
    EXPECT_THROW(settling.settle(), Cancelled);

    // In the second sample: the first one stays.
    told = {};
    told.allowed = counted.asked + 1;
    World world(sunk_sheet(), told.options());
    world.settle();
    world.advance_frame();
    EXPECT_THROW(world.advance_frame(), Cancelled);
    EXPECT_EQ(world.cloths()[0].positions, sample);
    EXPECT_THROW(world.advance_frame(), InvalidUse);
}

} // namespace
} // namespace toile::test
