#include <gtest/gtest.h>

#include <cmath>

#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace collision;
using namespace scenes;

namespace {

/// Flag fixed along one side, after ten frames of wind.
struct Flag {
    std::vector<Vec3> positions;
    long gust_calls;
};

Flag flag_in(const std::string& wind, int threads = 0)
{
    World world(parse_scene(R"({"toile": 1, "frames": 11, "solver": {"threads": )" + std::to_string(threads) +
                                R"(}, "wind": {"velocity": [3, 0, 0.5])" + wind + R"(},
        "cloths": [{"name": "flag", "fabric": "silk", "rectangle": {"size": [0.6, 0.4], "resolution": 0.02},
            "rotate_deg": [90, 0, 0]}],
        "attachments": [{"cloth": "flag", "select": {"box": {"lower": [-0.31, -1, -1], "upper": [-0.29, 1, 1]}}}]})",
                            "flag.json"));
    while (world.frame() < 10)
        world.advance_frame();
    return {world.cloths()[0].positions, world.stages().calls("garment/gusts")};
}

double max_distance(const Flag& a, const Flag& b)
{
    double distance = 0.0;
    for (size_t i = 0; i < a.positions.size(); ++i)
        distance = std::max(distance, (a.positions[i] - b.positions[i]).norm());
    return distance;
}

TEST(Wind, WithoutTurbulenceNeverComputesGusts)
{
    const Flag steady = flag_in("");
    EXPECT_EQ(steady.gust_calls, 0);
    EXPECT_EQ(max_distance(steady, flag_in(R"(, "turbulence": 0, "seed": 3)")), 0.0);
}

TEST(Wind, GustsAreReproducibleForASeedAndAnyThreadCount)
{
    const std::string gusty = R"(, "turbulence": 0.4)";
    const Flag one = flag_in(gusty, 1);
    EXPECT_GT(one.gust_calls, 0);
    EXPECT_EQ(max_distance(one, flag_in(gusty, 4)), 0.0);
    EXPECT_GT(max_distance(one, flag_in("")), 0.01);
    EXPECT_GT(max_distance(one, flag_in(gusty + R"(, "seed": 1)")), 0.01);
}

TEST(Wind, GustsKeepClothAwake)
{
    World world(
        parse_scene(R"({"toile": 1, "frames": 100, "wind": {"velocity": [0.2, 0, 0], "turbulence": 0.5},
        "avatars": [{"name": "floor", "plane": {}, "friction": 1}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.2, 0.2], "resolution": 0.04},
            "translate": [0, 0.0015, 0]}]})",
                    "breeze.json"));
    while (world.frame() < 60)
        world.advance_frame();
    const long minimised = world.stages().calls("pd/minimise");
    world.advance_frame();
    EXPECT_GT(world.stages().calls("pd/minimise"), minimised);
}

TEST(Air, LetsAFlatSheetFallAtItsTerminalSpeed)
{
    World world(parse_scene(
        R"({"toile": 1, "frames": 91, "solver": {"velocity_tolerance": 1e-3}, "fabrics": {"bare": {"base": "cotton", "areal_density": 0.1, "damping": 0}},
        "cloths": [{"name": "sheet", "fabric": "bare", "rectangle": {"size": [0.4, 0.4], "resolution": 0.05}}]})",
        "fall.json"));
    std::vector<Vec3> before;
    while (world.frame() < 90) {
        before = world.cloths()[0].positions;
        world.advance_frame();
    }
    const double terminal = std::sqrt(2.0 * 0.1 * 9.81 / 1.2); // 1/2 rho c_n v^2 = m g per area, c_n = 1
    for (size_t i = 0; i < before.size(); ++i) {
        const double speed = (before[i] - world.cloths()[0].positions[i]).y() * 30.0;
        EXPECT_NEAR(speed, terminal, 1e-3 * terminal);
    }
}

TEST(Wind, OfAStormStretchesSilkLittle)
{
    World world(parse_scene(R"({"toile": 1, "frames": 5, "wind": {"velocity": [30, 0, 0], "turbulence": 1},
        "cloths": [{"name": "flag", "fabric": "silk", "rectangle": {"size": [0.9, 0.6], "resolution": 0.05},
            "rotate_deg": [90, 0, 0]}],
        "attachments": [{"cloth": "flag", "select": {"box": {"lower": [-0.46, -1, -1], "upper": [-0.44, 1, 1]}}}]})",
                            "flag.json"));
    const double limit = world.cloths()[0].fabric.strain_limit;
    while (world.frame() < 4) {
        const StepReport report = world.advance_frame();
        const bool yields = report.status == StepReport::Status::Yielded; // where the flag folds on itself
        EXPECT_LE(report.max_strain, limit + (yields ? 0.15 : 0.05)) << "frame " << world.frame();
        EXPECT_LE(report.iterations, 16 * report.steps) << "frame " << world.frame();
    }
}

/// Force of a wind of 5 m/s on a silk sheet of 20 cm x 20 cm that soft springs attach across it [N].
double force_on_pinned_sheet(int substeps)
{
    World world(
        parse_scene(R"({"toile": 1, "frames": 60, "gravity": [0, 0, 0], "wind": {"velocity": [0, 5, 0]},
        "solver": {"substeps": )" +
                        std::to_string(substeps) + R"(, "velocity_tolerance": 1e-4},
        "fabrics": {"heavily_damped": {"base": "silk", "damping": 20, "bend": {"warp": 0.01, "weft": 0.01}}},
        "cloths": [{"name": "sheet", "fabric": "heavily_damped", "rectangle": {"size": [0.2, 0.2], "resolution": 0.05}}],
        "attachments": [{"cloth": "sheet", "select": {"box": {"lower": [-1, -1, -1], "upper": [1, 1, 1]}},
            "stiffness": 10}]})",
                    "held.json"));
    while (world.frame() < 59)
        world.advance_frame();
    double force = 0.0;
    for (const Vec3& x : world.cloths()[0].positions)
        force += 10.0 * x.y();
    return force;
}

TEST(Air, PullsAttachedClothWithTheWholeDragForAnyStep)
{
    const double drag = 0.5 * 1.2 * 0.2 * 0.2 * 5.0 * 5.0;
    EXPECT_NEAR(force_on_pinned_sheet(4), drag, 0.01 * drag);
    EXPECT_NEAR(force_on_pinned_sheet(16), drag, 0.01 * drag);
}

} // namespace
} // namespace toile::test
