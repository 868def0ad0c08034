#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace scenes;

namespace {

World world_of(const std::string& keys)
{
    return World(parse_scene("{\"toile\": 1, " + keys + "}", "test.json"));
}

Vec3 mean(const std::vector<Vec3>& points)
{
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : points)
        sum += p;
    return sum / double(points.size());
}

/// Max relative change of a distance between two vertices [-].
double distortion(const std::vector<Vec3>& rest, const std::vector<Vec3>& x)
{
    double largest = 0.0;
    for (size_t i = 1; i < x.size(); ++i) {
        const double length = (rest[i] - rest[0]).norm();
        largest = std::max(largest, std::abs((x[i] - x[0]).norm() - length) / length);
    }
    return largest;
}

const std::string kNoCloth = R"("cloths": [], "solver": {"velocity_tolerance": 1e-4}, )";
const std::string kFloor = R"("avatars": [{"name": "floor", "plane": {}}], )";

TEST(Solids, LandAndRestAtTheGapAndSleep)
{
    World world = world_of(kNoCloth + kFloor + R"("frames": 100,
        "solids": [{"name": "brick", "box": {"size": [0.2, 0.1, 0.06]}, "translate": [0, 0.2, 0], "rotate_deg": [20, 0, 30]}])");
    while (world.frame() < 60)
        world.advance_frame();
    const std::vector<Vec3>& x = world.surfaces()[0].positions;
    double lowest = 1.0;
    for (const Vec3& p : x)
        lowest = std::min(lowest, p.y());
    EXPECT_LE(lowest, 0.001);
    EXPECT_GE(lowest, 0.00085); // its weight compresses half of the spring's ramp
    EXPECT_LT(distortion(world.surfaces()[0].rest.positions, x), 1e-12);
    const long minimised = world.stages().calls("pd/minimise");
    while (world.frame() < 70)
        world.advance_frame();
    EXPECT_EQ(world.stages().calls("pd/minimise"), minimised);
}

/// Contact would throw up the brick that starts on the floor. What flies meanwhile keeps its motion.
TEST(Solids, RestOnTheFloorThatTheyStartOn)
{
    World world = world_of(kNoCloth + kFloor + R"("frames": 4, "contact": {"gap": 0.005}, "solids": [
        {"name": "brick", "box": {"size": [0.2, 0.1, 0.06]}, "translate": [0, 0.05, 0]},
        {"name": "flying", "box": {"size": [0.2, 0.1, 0.06]}, "translate": [0, 0.5, 0],
         "velocity": [1, 0, 0], "spin": [0, 0, 3]}])");
    EXPECT_GT(world.start().vertices_too_near(), 0);
    world.settle();
    EXPECT_GT(world.stages().calls("scenes/relax_start"), 0);
    const std::vector<Vec3> start = world.surfaces()[1].positions;
    while (world.frame() < 3) {
        world.advance_frame();
        for (const Vec3& p : world.surfaces()[0].positions)
            EXPECT_NEAR(p.y() > 0.05 ? p.y() - 0.1 : p.y(), 0.005, 5e-4) << world.frame();
    }
    const std::vector<Vec3>& x = world.surfaces()[1].positions;
    const Vec3 flown = mean(x) - mean(start);
    EXPECT_NEAR(flown.x(), 0.1, 1e-6);
    EXPECT_NEAR(flown.y(), -0.5 * 9.81 * 0.01, 2e-3);
    const Eigen::AngleAxisd turn(0.3, Vec3::UnitZ());
    for (size_t v = 0; v < x.size(); ++v)
        EXPECT_LT((x[v] - mean(x) - turn * (start[v] - mean(start))).norm(), 2e-3);
}

/// State of a box of width 0.1 and this height after a second on an incline with friction `friction`:
/// distance down the slope [m], and angle of its axis to the plane's normal [rad].
struct Slide {
    double distance, tilt;
};
Slide slide(double slope, double friction, double height)
{
    const double angle = std::atan(slope);
    const Vec3 up(std::sin(angle), std::cos(angle), 0.0);
    const std::string rotation =
        "\"rotate_deg\": [0, 0, " + std::to_string(-angle * 180.0 / std::numbers::pi) + "]";
    const Vec3 at = (0.001 + 0.5 * height) * up;
    World world = world_of(
        kNoCloth + R"("frames": 31, "avatars": [{"name": "incline", "plane": {}, "friction": )" +
        std::to_string(friction) + ", " + rotation +
        R"(}], "solids": [{"name": "box", "box": {"size": [0.1, )" + std::to_string(height) + ", 0.1]}, " +
        rotation + ", \"translate\": [" + std::to_string(at.x()) + ", " + std::to_string(at.y()) + ", 0]}]");
    const auto axis = [&] {
        const std::vector<Vec3>& x = world.surfaces()[0].positions;
        Vec3 sum = Vec3::Zero(); // the four top corners less the four others
        const std::vector<Vec3>& rest = world.surfaces()[0].rest.positions;
        for (size_t i = 0; i < x.size(); ++i)
            sum += (rest[i] - at).dot(up) > 0.0 ? x[i] : Vec3(-x[i]);
        return Vec3(sum.normalized());
    };
    const Vec3 start = mean(world.surfaces()[0].positions);
    while (world.frame() < 30)
        world.advance_frame();
    return {(mean(world.surfaces()[0].positions) - start).dot(Vec3(std::cos(angle), -std::sin(angle), 0.0)),
            std::acos(std::min(1.0, axis().dot(up)))};
}

TEST(Solids, StickOnAnInclineBelowTheFrictionAngle) { EXPECT_LT(slide(0.49, 0.5, 0.05).distance, 5e-4); }

TEST(Solids, SlideAtCoulombsAcceleration)
{
    const double angle = std::atan(0.6);
    const double dt = 1.0 / 120.0,
                 exact = 0.5 * 9.81 * (std::sin(angle) - 0.5 * std::cos(angle)) * (1.0 + dt);
    const Slide found = slide(0.6, 0.5, 0.05);
    EXPECT_NEAR(found.distance, exact, 0.02 * exact);
    EXPECT_LT(found.tilt, 0.01);
}

TEST(Solids, ToppleWhenTheirCentreIsBeyondTheirBase)
{
    // Width over height 0.5: the slope at which it topples.
    EXPECT_LT(slide(0.45, 1.0, 0.2).tilt, 0.01);
    EXPECT_GT(slide(0.55, 1.0, 0.2).tilt, 0.5);
}

TEST(Solids, StackAndExchangeMomentum)
{
    World world = world_of(kNoCloth + R"("frames": 20, "gravity": [0, 0, 0], "solids": [
        {"name": "left", "box": {"size": [0.1, 0.1, 0.1]}, "translate": [-0.1, 0.02, 0.01], "velocity": [1, 0, 0]},
        {"name": "right", "box": {"size": [0.1, 0.1, 0.1]}, "translate": [0.1, 0, 0], "density": 500}])");
    const Vec3 left = mean(world.surfaces()[0].positions), right = mean(world.surfaces()[1].positions);
    while (world.frame() < 12)
        world.advance_frame();
    const double t = world.frame() / 30.0;
    // Displacements weighted by mass show the total momentum, in units of the left one's mass.
    const Vec3 moved =
        mean(world.surfaces()[0].positions) - left + 0.5 * (mean(world.surfaces()[1].positions) - right);
    EXPECT_LT((moved - t * Vec3(1, 0, 0)).norm(), 1e-3);
    EXPECT_GT(mean(world.surfaces()[1].positions).x() - right.x(), 0.05);
}

TEST(Solids, LieOnPinnedClothAndSagIt)
{
    World world = world_of(R"("frames": 40, "solver": {"velocity_tolerance": 0.003},
        "cloths": [{"name": "sheet", "rectangle": {"size": [0.4, 0.4], "resolution": 0.02}}],
        "attachments": [{"cloth": "sheet", "select": {"nearest": [[0.2,0,0.2], [-0.2,0,0.2], [0.2,0,-0.2], [-0.2,0,-0.2]]}}],
        "solids": [{"name": "ball", "sphere": {"radius": 0.04}, "density": 200, "translate": [0, 0.06, 0]}])");
    while (world.frame() < 30)
        world.advance_frame();
    const Vec3 ball = mean(world.surfaces()[1].positions);
    EXPECT_GT(ball.y(), -0.15); // not through the cloth
    EXPECT_LT(ball.y(), 0.03);  // supported in its sag
    // It rolls in the sag, by 1 to 42 mm depending on the last digits, the tolerance and the step.
    EXPECT_LT(Vec2(ball.x(), ball.z()).norm(), 0.08);
    EXPECT_LT(distortion(world.surfaces()[1].rest.positions, world.surfaces()[1].positions), 1e-3);
}

TEST(Solids, AreRefusedInScenesThatDoNotSupportThem)
{
    const std::string ball = R"("frames": 1, "cloths": [], "solids": [{"name": "ball", "sphere": {}}])";
    EXPECT_NO_THROW(parse_scene("{\"toile\": 1, " + ball + "}", "a.json"));
    EXPECT_THROW(parse_scene("{\"toile\": 1, \"contact\": {\"self\": false}, " + ball + "}", "a.json"),
                 InvalidInput);
    EXPECT_THROW(parse_scene("{\"toile\": 1, \"solver\": {\"method\": \"vbd\"}, " + ball + "}", "a.json"),
                 InvalidInput);
    EXPECT_THROW(
        parse_scene("{\"toile\": 1, \"avatars\": [{\"name\": \"ball\", \"plane\": {}}], " + ball + "}",
                    "a.json"),
        InvalidInput);
}

} // namespace
} // namespace toile::test
