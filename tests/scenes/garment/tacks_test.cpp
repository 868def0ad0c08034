#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "garment/seam/tacks.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/backend.h"
#include "scenes/world/world.h"
#include "scenes/world/world_crossings.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// Cloth that tacks and buttons hold together.
namespace toile::test {

using namespace scenes;

namespace {

constexpr double kGap = 0.1;      // [m] between the squares
constexpr double kDensity = 0.15; // [kg/m^2]

/// Two squares of 10 cm in the plane z = 0, one below the other. The lower end of the upper one is at y = 0.
std::string squares()
{
    std::string text;
    for (const double top : {0.1, -kGap})
        for (const double drop : {0.0, 0.05, 0.1})
            for (const double x : {-0.05, 0.0, 0.05})
                text += "v " + std::to_string(x) + " " + std::to_string(top - drop) + " 0\n";
    for (const int first : {1, 10})
        for (const int row : {0, 3})
            for (const int column : {0, 1}) {
                const int v = first + row + column;
                for (const auto& t : {std::array{v, v + 3, v + 4}, {v, v + 4, v + 1}})
                    text += "f " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " +
                            std::to_string(t[2]) + "\n";
            }
    return text;
}

/// Lower end of the upper square, upper end of the lower one, in their middles and corners.
constexpr int kUpper = 7, kLower = 10;

class TackScene : public testing::Test {
protected:
    TackScene() { folder_.write("cloth.obj", squares()); }

    /// The upper square is held.
    Scene scene_of(const std::string& tacks, const std::string& keys = "", const std::string& cloth_keys = "")
    {
        return parse_scene(R"({"toile": 1, "frames": 90, "air": {"density": 0}, "contact": {"self": false},
            "fabrics": {"plain": {"areal_density": 0.15, "damping": 4}},
            "cloths": [{"name": "c", "file": "cloth.obj", "fabric": "plain", "tacks": [)" +
                               tacks + "]" + cloth_keys + R"(}],
            "attachments": [{"cloth": "c", "select": {"vertices": [0, 1, 2, 3, 4, 5, 6, 7, 8]}}])" +
                               keys + "}",
                           folder_.path() / "scene.json");
    }

    std::string refusal_of(const std::string& tacks, const std::string& keys = "")
    {
        std::string text = refusal([&] {
            const Scene scene = scene_of(tacks, keys);
            (void)load_cloth(scene, scene.cloths[0], {}, {});
        });
        const std::string folder = folder_.path().string() + "/";
        for (size_t at = 0; (at = text.find(folder)) != std::string::npos;)
            text.erase(at, folder.size());
        return text;
    }

    TemporaryFolder folder_;
};

/// Height of the upper square's point over the lower one's [m].
double gap_of(const World& world, int lower = kLower)
{
    const std::vector<Vec3>& x = world.cloths()[0].positions;
    return x[kUpper].y() - x[size_t(lower)].y();
}

} // namespace

/// No gravity: the threads alone move the lower square.
TEST_F(TackScene, ClosesAtItsSpeedFromItsTimeOnWithoutSwingingPast)
{
    constexpr double kCloseAt = 0.2;
    World world(scene_of(R"({"a": 7, "b": 10, "close_at": 0.2})", R"(, "gravity": [0, 0, 0])"));
    double previous = kGap;
    for (int frame = 1; frame <= 45; ++frame) {
        ASSERT_LE(world.advance_frame().status, StepReport::Status::Converged);
        const double t = frame / 30.0, gap = gap_of(world);
        const double expected = std::clamp(kGap - garment::Tacks::kSpeed * (t - kCloseAt), 0.0, kGap);
        EXPECT_LT(gap, expected + 0.001) << t;
        EXPECT_GT(gap, expected - 0.01) << t << ": the thread does not push";
        EXPECT_GT(gap, -0.001) << t;
        EXPECT_LT(gap, previous + 0.001) << t;
        previous = gap;
    }
    EXPECT_LT((world.cloths()[0].positions[kUpper] - world.cloths()[0].positions[kLower]).norm(), 1e-4);
}

/// At rest the thread carries the weight of the square below: k gap = m g.
TEST_F(TackScene, HoldsTheWeightBelow)
{
    World world(scene_of(R"({"a": 7, "b": 10})"));
    while (world.frame() + 1 < world.frame_count())
        ASSERT_NE(world.advance_frame().status, StepReport::Status::NonFinite);
    const double weight = kDensity * 0.1 * 0.1 * 9.81; // [N]
    EXPECT_NEAR(gap_of(world), weight / garment::Tacks::kStiffness, 1e-6);
}

TEST_F(TackScene, LeavesClothWithoutTacksAsItIs)
{
    World world(scene_of(R"({"a": 7, "b": 10, "close_at": 100})"));
    World without(scene_of(""));
    for (int frame = 0; frame < 5; ++frame) {
        (void)world.advance_frame();
        (void)without.advance_frame();
    }
    const double fall = 9.81 * 0.5 * std::pow(5.0 / 30.0, 2);
    EXPECT_NEAR(gap_of(world), gap_of(without), 1e-6);
    EXPECT_GT(gap_of(world), kGap + 0.5 * fall) << "nothing holds it before its time";
}

/// Asleep cloth wakes at the time of a tack.
TEST_F(TackScene, WakesSleepingCloth)
{
    World world(scene_of(R"({"a": 7, "b": 10, "close_at": 2})", R"(, "gravity": [0, 0, 0])"));
    for (int frame = 0; frame < 80; ++frame)
        (void)world.advance_frame();
    EXPECT_LT(gap_of(world), 0.08);
}

TEST_F(TackScene, NamesMistakes)
{
    EXPECT_EQ(refusal_of(R"({"a": 7, "b": 10})"), "");
    EXPECT_EQ(refusal_of(R"({"a": 7})"), "scene.json: cloths[0].tacks[0]: the key \"b\" is missing; add it");
    EXPECT_EQ(refusal_of(R"({"a": 7, "b": 18})"),
              "scene.json: cloths[0].tacks[0].b: vertex 18 is out of range; \"c\" has vertices 0 to 17");
    EXPECT_EQ(refusal_of(R"({"a": 7, "b": 10}, {"a": 7, "b": 7})"),
              "scene.json: cloths[0].tacks[1]: vertices 7 and 7 are one point of \"c\"; name two");
    EXPECT_EQ(refusal_of(R"({"a": 7, "b": 10, "close_at": -1})"),
              "scene.json: cloths[0].tacks[0].close_at: -1 is out of range; give a number from 0 to 86400 s");
    EXPECT_EQ(refusal_of(R"({"a": 7, "b": 10})", R"(, "solver": {"method": "xpbd"})"),
              "scene.json: cloths[0].tacks: are unknown to solver.method \"xpbd\"; choose another method, or "
              "remove them");
    EXPECT_EQ(why_not_on_gpu(scene_of(R"({"a": 7, "b": 10})")), "tacks run on the CPU only");
    EXPECT_EQ(why_not_on_gpu(scene_of("")), "");
}

} // namespace toile::test
