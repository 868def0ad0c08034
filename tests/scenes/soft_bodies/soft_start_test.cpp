#include <gtest/gtest.h>

#include <array>

#include "scenes/world/start_pose.h"
#include "tests/scenes/soft_bodies/soft_body_test.h"

namespace toile::test {

using namespace scenes;
using collision::StartDefect;
using Kind = StartDefect::Kind;

namespace {

class SoftStart : public SoftBodyTest {
protected:
    /// Two blocks, of which the second starts 5 mm deep in the top of the first.
    World stacked(int lower_layer, int upper_layer) const
    {
        return world_of(
            R"("frames": 1, "cloths": [], "soft_bodies": [)" +
            block("lower", R"("layer": )" + std::to_string(lower_layer)) + ", " +
            block("upper", R"("translate": [0.02, 0.095, 0.01], "layer": )" + std::to_string(upper_layer)) +
            "]");
    }
};

double max_move(const std::vector<Vec3>& from, const std::vector<Vec3>& to)
{
    double move = 0.0;
    for (size_t v = 0; v < from.size(); ++v)
        move = std::max(move, (to[v] - from[v]).norm());
    return move;
}

TEST_F(SoftStart, IsOnlyCheckedWhereItIsClean)
{
    World world = world_of(kFloor + R"("frames": 1, "cloths": [], "soft_bodies": [)" +
                           block("jelly", R"("translate": [0, 0.002, 0])") + "]");
    EXPECT_EQ(world.stages().calls("scenes/start_check"), 1);
    EXPECT_EQ(world.stages().calls("scenes/start_repair"), 0);
    world.settle();
    EXPECT_EQ(world.stages().calls("scenes/relax_start"), 0);
}

TEST_F(SoftStart, MovesBodiesOffAvatarsWithoutThrowingThem)
{
    World world = world_of(kFloor + R"("frames": 6, "cloths": [], "soft_bodies": [)" +
                           block("jelly", R"("young": 20000, "translate": [0, -0.008, 0])") + "]");
    EXPECT_GT(world.start().count(Kind::InsideBody), 0);
    EXPECT_EQ(world.start().remaining(Kind::InsideBody), 0);
    EXPECT_GT(lowest(world.surfaces()[0].positions), 0.0);
    world.settle();
    EXPECT_GT(world.stages().calls("scenes/relax_start"), 0);
    EXPECT_EQ(world.inverted_tets()[0], 0);
    const double start = mean(world.surfaces()[0].positions).y();
    while (world.frame() < 5) {
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
        EXPECT_LT(mean(world.surfaces()[0].positions).y(), start + 5e-4) << world.frame();
    }
}

TEST_F(SoftStart, KeepsTheVelocityOfTheStart)
{
    World world = world_of(kFloor + R"("frames": 3, "cloths": [], "soft_bodies": [)" +
                           block("jelly", R"("translate": [0, -0.008, 0], "velocity": [0, 3, 0])") + "]");
    world.settle();
    const double start = mean(world.surfaces()[0].positions).y(), t = 2.0 / 30.0;
    world.advance_frame();
    world.advance_frame();
    EXPECT_NEAR(mean(world.surfaces()[0].positions).y() - start, 3.0 * t - 0.5 * 9.81 * t * t, 5e-3);
}

TEST_F(SoftStart, MovesTheHigherLayerOrTheLaterBody)
{
    const World as_listed = stacked(0, 1), reversed = stacked(1, 0), equal = stacked(2, 2);
    for (const World* world : {&as_listed, &reversed, &equal}) {
        EXPECT_GT(world->start().count(Kind::CrossesBody), 0);
        EXPECT_EQ(world->start().remaining(Kind::CrossesBody), 0);
        EXPECT_EQ(world->start().remaining(Kind::InsideBody), 0);
        EXPECT_EQ(crossing_count(*world), 0);
    }
    const auto moves = [](const World& world) {
        std::array<double, 2> result{};
        for (int body : {0, 1})
            result[body] = world.start().changes[body].max_move;
        return result;
    };
    EXPECT_EQ(moves(as_listed)[0], 0.0);
    EXPECT_GT(moves(as_listed)[1], 0.004);
    EXPECT_GT(moves(reversed)[0], 0.004);
    EXPECT_EQ(moves(reversed)[1], 0.0);
    EXPECT_EQ(moves(equal), moves(as_listed));
}

TEST_F(SoftStart, SaysWhichBodiesAreInsideOthers)
{
    const auto bodies = [&](const std::string& first, const std::string& second) {
        return R"("frames": 1, "cloths": [], "soft_bodies": [)" + block("first", first) + ", " +
               block("second", second) + "]";
    };
    const std::string large = R"("young": 1e5)", small = R"("scale": 0.3, "translate": [0.03, 0.03, 0.03])";
    EXPECT_NE(refusal(bodies(large, small)).find("soft body \"second\" does not fit"), std::string::npos);
    // The later one is not moved off what it encloses, from the start or once it is moved out.
    for (const std::string& second : {large, std::string(R"("translate": [0, 0.003, 0])")}) {
        const World world = world_of(bodies(second == large ? small : large, second));
        EXPECT_GT(world.start().remaining(Kind::InsideBody), 0);
        EXPECT_EQ(world.start().defects.back().cloth, 0);
        EXPECT_EQ(world.start().defects.back().other, 1);
    }
}

TEST_F(SoftStart, MovesClothOutOfBodiesThatItDoesNotCross)
{
    // All of the patch is 4 mm below the top of the block.
    World world = world_of(R"("frames": 1, "cloths": [{"name": "patch", "translate": [0.05, 0.096, 0.05],
        "rectangle": {"size": [0.06, 0.06], "resolution": 0.01}}], "soft_bodies": [)" +
                           block("jelly", R"("young": 1e5)") + "]");
    ASSERT_GT(world.start().count(Kind::InsideBody), 0);
    for (const StartDefect& defect : world.start().defects) {
        EXPECT_EQ(defect.cloth, 0);
        EXPECT_EQ(defect.other, 0); // of the bodies: there is no avatar
    }
    EXPECT_EQ(world.start().remaining(Kind::InsideBody), 0);
    EXPECT_GT(lowest(world.surfaces()[0].positions), 0.1);
    EXPECT_EQ(world.start().changes[1].max_move, 0.0);
}

TEST_F(SoftStart, NamesWhatItNumbers)
{
    // The second cloth starts in the second body, which crosses the first one and the second avatar.
    const Scene scene = scene_of(R"("frames": 1,
        "avatars": [{"name": "ball", "sphere": {"radius": 0.01}, "translate": [1, 1, 1]}, {"name": "floor", "plane": {}}],
        "cloths": [{"name": "far", "translate": [2, 1, 0], "rectangle": {"size": [0.06, 0.06], "resolution": 0.01}},
                   {"name": "patch", "translate": [0.18, 0.094, 0.05], "rectangle": {"size": [0.04, 0.04], "resolution": 0.01}}],
        "contact": {"repair_start": false}, "soft_bodies": [)" +
                                 block("first", R"("translate": [0, 0.002, 0])") + ", " +
                                 block("second", R"("translate": [0.096, -0.002, 0.01])") + "]");
    const World world(scene);
    int found[3] = {};
    for (const StartDefect& defect : world.start().defects) {
        ASSERT_TRUE(defect.is_with_body());
        const std::string names =
            surface_of(scene, defect.cloth).quoted() + ", " + body_of(scene, defect.other).quoted();
        const std::array<std::string, 3> expected{"cloth \"patch\", soft body \"second\"",
                                                  "soft body \"second\", soft body \"first\"",
                                                  "soft body \"second\", avatar \"floor\""};
        const auto at = std::find(expected.begin(), expected.end(), names);
        if (names != "soft body \"first\", soft body \"second\"") { // as far as it lies inside
            ASSERT_NE(at, expected.end()) << names;
            ++found[at - expected.begin()];
        }
    }
    EXPECT_TRUE(found[0] > 0 && found[1] > 0 && found[2] > 0);
}

/// Contact would throw what starts nearer to a body than its gap: a stiff block on the floor by 65 mm.
TEST_F(SoftStart, RestsOnTheFloorThatItStartsOn)
{
    const auto on_floor = [&](const std::string& more) {
        return kFloor + R"("frames": 8, "contact": {"gap": 0.005)" + more + R"(}, "cloths": [],
            "soft_bodies": [)" +
               block("jelly", R"("young": 1e8)") + "]";
    };
    World world = world_of(on_floor(""));
    EXPECT_TRUE(world.start().defects.empty());
    EXPECT_GT(world.start().vertices_too_near(), 0);
    EXPECT_EQ(world.stages().calls("scenes/start_repair"), 0);
    world.settle();
    EXPECT_GT(world.stages().calls("scenes/relax_start"), 0);
    for (;;) {
        EXPECT_NEAR(lowest(world.surfaces()[0].positions), 0.005, 2e-4) << world.frame();
        if (world.frame() == 7)
            break;
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
    }

    World left = world_of(on_floor(R"(, "repair_start": false)"));
    left.settle();
    EXPECT_EQ(left.stages().calls("scenes/relax_start"), 0);
    EXPECT_EQ(lowest(left.surfaces()[0].positions), 0.0);
}

/// An impact in the first step, of what touched while it relaxed.
TEST_F(SoftStart, HitsTheFloorThatItStartsOn)
{
    World world = world_of(kFloor + R"("frames": 6, "cloths": [], "soft_bodies": [)" +
                           block("stiff", R"("young": 1e9, "velocity": [0, -3, 0])") + "]");
    world.settle();
    const double start = mean(world.surfaces()[0].positions).y();
    while (world.frame() < 5) {
        EXPECT_EQ(world.advance_frame().status, StepReport::Status::Converged);
        EXPECT_LT(mean(world.surfaces()[0].positions).y(), start + 1e-3) << world.frame();
    }
}

TEST_F(SoftStart, KeepsItsVelocityWhereItStartsOnTheFloor)
{
    World world = world_of(kFloor + R"("frames": 2, "cloths": [], "soft_bodies": [)" +
                           block("jelly", R"("velocity": [0, 2, 0])") + "]");
    world.settle();
    const double start = mean(world.surfaces()[0].positions).y();
    world.advance_frame();
    EXPECT_NEAR(mean(world.surfaces()[0].positions).y() - start, 2.0 / 30 - 0.5 * 9.81 / 900, 2e-3);
}

TEST_F(SoftStart, RelaxesInSmallStepsToo)
{
    World world =
        world_of(kFloor + R"("frames": 4, "solver": {"substeps": 32}, "cloths": [], "soft_bodies": [)" +
                 block("jelly", R"("young": 20000, "translate": [0, -0.004, 0])") + "]");
    world.settle();
    const double start = mean(world.surfaces()[0].positions).y();
    while (world.frame() < 3) {
        world.advance_frame();
        EXPECT_LT(mean(world.surfaces()[0].positions).y(), start + 5e-4) << world.frame();
    }
}

TEST_F(SoftStart, LeavesHeldVerticesWhereTheyAre)
{
    World world = world_of(kFloor + R"("frames": 1, "cloths": [], "attachments": [{"cloth": "jelly",
        "select": {"box": {"lower": [-1, 0.085, -1], "upper": [1, 1, 1]}}}], "soft_bodies": [)" +
                           block("jelly", R"("translate": [0, -0.003, 0])") + "]");
    EXPECT_EQ(world.start().remaining(Kind::InsideBody), 0);
    const ClothState& jelly = world.surfaces()[0];
    int held = 0;
    for (size_t v = 0; v < jelly.positions.size(); ++v)
        if (jelly.rest.positions[v].y() > 0.085) {
            ++held;
            EXPECT_EQ(jelly.positions[v], jelly.rest.positions[v]);
        }
    EXPECT_GT(held, 0);
}

TEST_F(SoftStart, IsLeftAsItIsOrRefusedByName)
{
    const auto sunk = [&](const std::string& y, const std::string& more) {
        return kFloor + R"("frames": 1, "cloths": [], "soft_bodies": [)" +
               block("jelly", R"("translate": [0, )" + y + ", 0]") + "]" + more;
    };
    const World world = world_of(sunk("-0.008", R"(, "contact": {"repair_start": false})"));
    EXPECT_GT(world.start().count(Kind::InsideBody), 0);
    EXPECT_EQ(max_move(world.surfaces()[0].positions, world.surfaces()[0].rest.positions), 0.0);
    const std::string message = refusal(sunk("-0.07", ""));
    EXPECT_NE(message.find("soft body \"jelly\" does not fit its start pose"), std::string::npos) << message;
    EXPECT_NE(message.find("translate"), std::string::npos) << message;
}

} // namespace

} // namespace toile::test
