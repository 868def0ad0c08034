#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scenes/format/read_scene.h"
#include "scenes/world/world_crossings.h"

namespace toile::test {

using namespace collision;
using namespace scenes;

namespace {

World world_of(const std::string& json) { return World(parse_scene(json, "test.json")); }

void expect_no_crossing(World& world, int frames)
{
    for (int frame = 0; frame < frames; ++frame) {
        ASSERT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
        ASSERT_EQ(crossing_count(world), 0) << "frame " << world.frame();
    }
}

std::string sheet(const std::string& name, double size, const std::string& place,
                  const std::string& more = "")
{
    return R"({"name": ")" + name + R"(", "rectangle": {"size": [)" + std::to_string(size) + ", " +
           std::to_string(size) + R"(], "resolution": 0.02}, "translate": )" + place + more + "}";
}

const std::string kFloor = R"("avatars": [{"name": "floor", "plane": {}}])";

TEST(ClothContact, LayersRestOnEachOtherAtTheirThickness)
{
    World world = world_of(R"({"toile": 1, "frames": 60, )" + kFloor + R"(, "cloths": [)" +
                           sheet("low", 0.2, "[0, 0.003, 0]") + "," +
                           sheet("high", 0.16, "[0.003, 0.006, 0.002]", R"(, "thickness": 0.002)") + "]}");
    expect_no_crossing(world, 30);
    // Half of 2 mm and half of cotton's thickness, between middle surfaces.
    const double thickness = 0.5 * (0.002 + world.cloths()[0].fabric.thickness);
    double low = 0.0, high = 0.0;
    for (const Vec3& p : world.cloths()[0].positions)
        low += p.y() / world.cloths()[0].positions.size();
    for (const Vec3& p : world.cloths()[1].positions)
        high += p.y() / world.cloths()[1].positions.size();
    EXPECT_NEAR(high - low, thickness, 0.1 * thickness);
}

TEST(ClothContact, NeverCrossesInASheetDroppedOnItsEdge)
{
    for (const char* thickness : {"0.0001", "0.0006"}) {
        SCOPED_TRACE(thickness);
        World world =
            world_of(R"({"toile": 1, "frames": 40, )" + kFloor + R"(, "cloths": [)" +
                     sheet("sheet", 0.24, "[0, 0.13, 0]",
                           std::string(R"(, "rotate_deg": [88, 10, 3], "thickness": )") + thickness) +
                     "]}");
        expect_no_crossing(world, 25);
    }
}

TEST(ClothContact, StopsAttachedClothBeforeItCrosses)
{
    // The upper sheet's border is moved through the lower sheet, which is attached itself.
    World world = world_of(R"({"toile": 1, "frames": 20, "cloths": [)" + sheet("low", 0.3, "[0, 0, 0]") +
                           "," + sheet("high", 0.12, "[0.007, 0.01, 0.003]") +
                           R"(], "attachments": [
        {"cloth": "low", "select": {"box": {"lower": [-1, -1, -1], "upper": [1, 1, 1]}}},
        {"cloth": "high", "select": {"box": {"lower": [-1, -1, -1], "upper": [-0.04, 1, 1]}},
         "keyframes": [{"time": 0}, {"time": 0.4, "translate": [0, -0.1, 0]}]}]})");
    expect_no_crossing(world, 15);
    for (const Vec3& p : world.cloths()[1].positions)
        EXPECT_GT(p.y(), 0.0);
}

/// Distance that a sheet slides down a tilted, fixed one in a third of a second [m].
double slide_on_cloth(double slope, double friction)
{
    const double angle = std::atan(slope);
    const std::string tilt =
        R"(, "rotate_deg": [0, 0, )" + std::to_string(-angle * 180.0 / std::numbers::pi) + "]";
    World world = world_of(
        R"({"toile": 1, "frames": 12, "air": {"density": 0}, "solver": {"substeps": 16},
            "fabrics": {"calm": {"base": "cotton", "damping": 0}},
            "contact": {"friction": 2.0, "friction_pairs": [{"between": ["calm", "calm"], "friction": )" +
        std::to_string(friction) + R"(}]}, "cloths": [)" +
        sheet("ramp", 0.4, "[0, 0, 0]", tilt + R"(, "fabric": "calm")") + "," +
        sheet("slider", 0.1,
              "[" + std::to_string(0.0004 * std::sin(angle)) + ", " +
                  std::to_string(0.0004 * std::cos(angle)) + ", 0.003]",
              tilt + R"(, "fabric": "calm")") +
        R"(], "attachments": [{"cloth": "ramp", "select": {"box": {"lower": [-1, -1, -1], "upper": [1, 1, 1]}}}]})");
    const std::vector<Vec3> start = world.cloths()[1].positions;
    for (int frame = 0; frame < 10; ++frame)
        (void)world.advance_frame();
    Vec3 moved = Vec3::Zero();
    for (size_t v = 0; v < start.size(); ++v)
        moved += (world.cloths()[1].positions[v] - start[v]) / start.size();
    return moved.norm();
}

TEST(ClothContact, HasTheFrictionOfItsPairOfMaterials)
{
    EXPECT_LT(slide_on_cloth(0.3, 0.4), 0.002);
    const double angle = std::atan(0.3), exact = 0.5 / 9.0 * 9.81 * (std::sin(angle) - 0.1 * std::cos(angle));
    EXPECT_NEAR(slide_on_cloth(0.3, 0.1), exact, 0.15 * exact);
}

TEST(ClothContact, CostsNothingWhenOff)
{
    const std::string cloths = R"("cloths": [)" + sheet("a", 0.1, "[0, 0.1, 0]") + "]}";
    World off = world_of(R"({"toile": 1, "frames": 3, "contact": {"self": false}, )" + cloths);
    (void)off.advance_frame();
    for (const char* stage :
         {"collision/near_pairs", "collision/collision_free_step", "scenes/find_crossings"})
        EXPECT_EQ(off.stages().calls(stage), 0) << stage;
    World world = world_of(R"({"toile": 1, "frames": 3, )" + cloths);
    (void)world.advance_frame();
    (void)world.advance_frame();
    EXPECT_EQ(world.stages().calls("scenes/find_crossings"), 0);  // clean at loading
    EXPECT_EQ(world.stages().calls("collision/search_again"), 0); // free fall is as expected
    EXPECT_EQ(world.stages().calls("pd/pcg"), 0);
    world.place(0, std::vector<Vec3>(world.cloths()[0].positions));
    (void)world.advance_frame();
    (void)world.advance_frame();
    EXPECT_EQ(world.stages().calls("scenes/find_crossings"), 1); // clean again
}

/// Two sheets that fall onto the floor.
World two_layers(const std::string& more = "")
{
    return world_of(R"({"toile": 1, "frames": 3, )" + kFloor + more + R"(, "cloths": [)" +
                    sheet("low", 0.1, "[0, 0.002, 0]") + "," + sheet("high", 0.1, "[0.003, 0.003, 0.002]") +
                    "]}");
}

World preconditioned_by(const std::string& word)
{
    return two_layers(R"(, "solver": {"outer": "lbfgs", "contact_preconditioner": ")" + word + R"("})");
}

TEST(ClothContact, UsesThePreconditionerOfTheScene)
{
    for (const auto& [word, stage] :
         {std::pair("exact", "pd/contact_factor"), std::pair("sherman-morrison", "pd/nested_contacts"),
          std::pair("chebyshev", "pd/nested_chebyshev"), std::pair("paper", "pd/paper_projection")}) {
        World world = preconditioned_by(word);
        (void)world.advance_frame();
        EXPECT_GT(world.stages().calls(stage), 0) << word;
        World usual = preconditioned_by("block");
        (void)usual.advance_frame();
        EXPECT_GT(usual.stages().calls("pd/nested_blocks"), 0);
        EXPECT_EQ(usual.stages().calls(stage), 0) << word;
    }
}

TEST(ClothContact, SeparatesClothThatCrossesAtTheStart)
{
    // A sheet that stands through another one, neither repaired: it falls out on the side of its weight.
    World world = world_of(
        R"({"toile": 1, "frames": 90, "contact": {"repair_start": false}, "cloths": [)" +
        sheet("held", 0.3, "[0, 0, 0]") + "," +
        sheet("through", 0.1, "[0.003, -0.02, 0.002]", R"(, "rotate_deg": [90, 0, 0])") +
        R"(], "attachments": [{"cloth": "held", "select": {"box": {"lower": [-1, -1, -1], "upper": [1, 1, 1]}}}]})");
    EXPECT_GT(crossing_count(world), 0);
    for (int frame = 0; frame < 30; ++frame)
        ASSERT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    EXPECT_EQ(crossing_count(world), 0);
    for (const Vec3& p : world.cloths()[1].positions)
        EXPECT_LT(p.y(), 0.0);
}

TEST(ClothContact, HasTheSameBitsForEveryThreadCount)
{
    std::vector<std::vector<Vec3>> ends;
    for (const char* threads : {"1", "2"}) {
        World world = world_of(R"({"toile": 1, "frames": 12, "solver": {"threads": )" + std::string(threads) +
                               "}, " + kFloor + R"(, "cloths": [)" +
                               sheet("low", 0.2, "[0, 0.03, 0]", R"(, "rotate_deg": [20, 0, 10])") + "," +
                               sheet("high", 0.2, "[0.03, 0.06, 0.02]") + "]}");
        for (int frame = 0; frame < 8; ++frame)
            (void)world.advance_frame();
        ends.push_back(world.cloths()[1].positions);
    }
    EXPECT_EQ(ends[0], ends[1]);
}

} // namespace
/// A sheet that is wrung until its borders are a quarter too short has no pose that keeps all. Its steps give
/// up soon: cloth is not moved back over and over, in longer steps.
TEST(ClothContact, SheetWrungTooFarCostsFewIterations)
{
    World world = world_of(R"({"toile": 1, "frames": 15, "gravity": [0, 0, 0],
        "cloths": [{"name": "sheet", "rectangle": {"size": [1, 0.5], "resolution": 0.1}}],
        "attachments": [
            {"cloth": "sheet", "select": {"box": {"lower": [-0.51, -1, -1], "upper": [-0.49, 1, 1]}},
             "keyframes": [{"time": 0}, {"time": 0.75, "rotate_deg": [-720, 0, 0], "translate": [0.1, 0, 0]}]},
            {"cloth": "sheet", "select": {"box": {"lower": [0.49, -1, -1], "upper": [0.51, 1, 1]}},
             "keyframes": [{"time": 0}, {"time": 0.75, "rotate_deg": [720, 0, 0], "translate": [-0.1, 0, 0]}]}]})");
    int iterations = 0, steps = 0;
    for (int frame = 1; frame < 15; ++frame) {
        const StepReport report = world.advance_frame();
        EXPECT_EQ(crossing_count(world), 0) << "frame " << frame;
        if (frame < 12)
            continue;
        EXPECT_NE(report.status, StepReport::Status::Converged) << "it cannot";
        iterations += report.iterations;
        steps += report.steps;
    }
    // 16 without Newton::Patience. Single frames have 7 to 12, by the rounding of the processor.
    EXPECT_LE(iterations, 11 * steps);
}

} // namespace toile::test
