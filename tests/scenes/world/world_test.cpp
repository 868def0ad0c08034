#include "scenes/world/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "scenes/format/read_scene.h"

namespace toile::test {

using namespace collision;
using namespace scenes;

namespace {

/// World from scene text without the version key and the outer braces.
World world_of(const std::string& keys)
{
    return World(parse_scene("{\"toile\": 1, " + keys + "}", "test.json"));
}

/// Fabric without damping, in a scene without air.
const std::string kUndamped =
    R"("air": {"density": 0}, "fabrics": {"bare": {"base": "cotton", "damping": 0}}, )";

Vec3 mean(const std::vector<Vec3>& points)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points)
        sum += p;
    return sum / double(points.size());
}

double max_move(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double max = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        max = std::max(max, (a[i] - b[i]).norm());
    return max;
}

TEST(World, LetsClothFallExactly)
{
    World world =
        world_of(kUndamped + R"("frames": 31, "solver": {"substeps": 4, "integrator": "implicit-euler"},
        "cloths": [{"name": "sheet", "fabric": "bare", "rectangle": {"size": [0.5, 0.3], "resolution": 0.05}, "rotate_deg": [20, 30, 40]}])");
    const std::vector<Vec3> start = world.cloths()[0].positions;
    int iterations = 0;
    while (world.frame() < 30)
        iterations += world.advance_frame().iterations;

    // Exact solution of implicit Euler: x_n = x_0 - g dt^2 n (n + 1) / 2.
    const double dt = 1.0 / 120.0, n = 120.0;
    for (size_t i = 0; i < start.size(); ++i)
        EXPECT_LT(
            (world.cloths()[0].positions[i] - start[i] + Vec3(0, 9.81 * dt * dt * n * (n + 1) / 2, 0)).norm(),
            1e-12);
    EXPECT_EQ(iterations, 0);
}

TEST(World, LetsClothFallToSecondOrder)
{
    World world = world_of(kUndamped + R"("frames": 31,
        "cloths": [{"name": "sheet", "fabric": "bare", "rectangle": {"size": [0.5, 0.3], "resolution": 0.05}}])");
    const Vec3 start = mean(world.cloths()[0].positions);
    while (world.frame() < 30)
        world.advance_frame();
    // The first step is one of implicit Euler: g dt^2 / 2 too far, and g dt / 2 too fast for a fraction.
    const double dt = 1.0 / 120.0;
    EXPECT_NEAR(start.y() - mean(world.cloths()[0].positions).y(), 0.5 * 9.81, 9.81 * dt * dt);
}

/// Mean displacement along an incline of slope `slope` after one second at friction 0.5, down the slope [m].
double slide(double slope)
{
    const double angle = std::atan(slope);
    const double degrees = angle * 180.0 / std::numbers::pi;
    const double gap = 0.001 + 0.5 * 0.318e-3;
    const std::string rotation = "\"rotate_deg\": [0, 0, " + std::to_string(-degrees) + "]";
    World world = world_of(
        kUndamped + R"("frames": 31, "solver": {"velocity_tolerance": 1e-5, "sleep": {"enabled": false}},
        "avatars": [{"name": "incline", "plane": {}, "friction": 0.5, )" +
        rotation + R"(}],
        "cloths": [{"name": "sheet", "fabric": "bare", "rectangle": {"size": [0.2, 0.2], "resolution": 0.04}, )" +
        rotation + ", \"translate\": [" + std::to_string(gap * std::sin(angle)) + ", " +
        std::to_string(gap * std::cos(angle)) + ", 0]}]");
    const Vec3 start = mean(world.cloths()[0].positions);
    while (world.frame() < 30)
        world.advance_frame();
    return (mean(world.cloths()[0].positions) - start).dot(Vec3(std::cos(angle), -std::sin(angle), 0.0));
}

/// One per cent below the angle at which it would slide for ever, a sheet creeps by friction's smoothing.
TEST(World, HoldsClothOnAnInclineUpToTheFrictionAngle) { EXPECT_LT(slide(0.5 * 0.99), 2.5e-3); }

TEST(World, LetsClothSlideOnePerCentAboveTheFrictionAngle) { EXPECT_GT(slide(0.5 * 1.01), 0.02); }

TEST(World, SlidesAtCoulombsAcceleration)
{
    const double angle = std::atan(0.6);
    const double exact =
        0.5 * 9.81 * (std::sin(angle) - 0.5 * std::cos(angle)); // 1/2 t^2 g (sin a - mu cos a)
    EXPECT_NEAR(slide(0.6), exact, 0.03 * exact);
}

TEST(World, RestsClothAtTheDeclaredGapAndThenSleeps)
{
    World world = world_of(R"("frames": 200, "avatars": [{"name": "floor", "plane": {}}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.03}, "translate": [0, 0.01, 0]}])");
    while (world.frame() < 60)
        world.advance_frame();
    for (const Vec3& p : world.cloths()[0].positions)
        EXPECT_NEAR(p.y(), 0.001 + 0.5 * 0.318e-3, 4e-5);

    const long minimised = world.stages().calls("pd/minimise");
    while (world.frame() < 70)
        world.advance_frame();
    EXPECT_EQ(world.stages().calls("pd/minimise"), minimised);
}

TEST(World, SkipsWhatASceneDoesNotNeed)
{
    World hanging = world_of(R"("frames": 5, "air": {"density": 0},
        "fabrics": {"limp": {"bend": {"warp": 0, "weft": 0}}},
        "cloths": [{"name": "sheet", "fabric": "limp", "rectangle": {"size": [0.3, 0.3], "resolution": 0.03}}],
        "attachments": [{"cloth": "sheet", "select": {"nearest": [[0.15, 0, 0.15]]}}])");
    while (hanging.frame() < 4)
        hanging.advance_frame();
    EXPECT_GT(hanging.stages().calls("pd/minimise"), 0);
    for (const char* stage : {"collision/detect", "collision/refit", "pd/pcg", "pd/nested_update",
                              "pd/nested", "pd/contact_blocks", "contact/evaluate", "garment/bending",
                              "garment/springs", "garment/aerodynamics", "avatars/advance", "avatars/skin"})
        EXPECT_EQ(hanging.stages().calls(stage), 0) << stage;
    EXPECT_EQ(hanging.stages().calls("linear/analyse"), 0);
    EXPECT_EQ(hanging.stages().calls("linear/factor"), 0);

    World falling = world_of(R"("frames": 5, "avatars": [{"name": "ball", "sphere": {"radius": 0.1}}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.03}, "translate": [0, 2, 0]}])");
    while (falling.frame() < 4)
        falling.advance_frame();
    EXPECT_GT(falling.stages().calls("collision/detect"), 0);
    for (const char* stage : {"pd/pcg", "pd/nested_update", "pd/nested", "pd/contact_blocks",
                              "contact/evaluate", "collision/refit", "avatars/advance"})
        EXPECT_EQ(falling.stages().calls(stage), 0) << stage;
}

std::vector<Vec3> draped_on_sphere(int threads)
{
    World world = world_of(R"("frames": 15, "solver": {"threads": )" + std::to_string(threads) + R"(},
        "avatars": [{"name": "ball", "mannequin": {}, "translate": [0, -1.55, 0]}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.6, 0.6], "resolution": 0.02}, "translate": [0, 0.25, 0]}])");
    while (world.frame() < 14)
        world.advance_frame();
    return world.cloths()[0].positions;
}

TEST(World, GivesTheSameBitsForAnyThreadCount)
{
    const std::vector<Vec3> one = draped_on_sphere(1);
    EXPECT_EQ(max_move(one, draped_on_sphere(2)), 0.0);
    EXPECT_EQ(max_move(one, draped_on_sphere(4)), 0.0);
}

TEST(World, SurvivesAnAvatarThatJumpsAMetre)
{
    World world =
        world_of(R"("frames": 60, "avatars": [{"name": "ball", "sphere": {"radius": 0.2}, "keyframes":
            [{"time": 0.5, "translate": [0, 0, 0]}, {"time": 0.501, "translate": [1, 0, 0]}]},
            {"name": "floor", "plane": {}, "translate": [0, -0.5, 0]}],
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.6, 0.6], "resolution": 0.04}, "translate": [0, 0.21, 0]}])");
    StepReport report;
    while (world.frame() < 59)
        report = world.advance_frame();
    EXPECT_NE(report.status, StepReport::Status::NonFinite);
    for (const Vec3& p : world.cloths()[0].positions)
        EXPECT_LT(p.norm(), 3.0);
}

} // namespace
} // namespace toile::test
