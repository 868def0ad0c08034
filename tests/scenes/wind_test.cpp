#include <gtest/gtest.h>

#include "scenes/format/read_scene.h"
#include "scenes/world.h"

namespace toile {
namespace {

/// A flag held along one side, after ten frames of wind.
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

double farthest(const Flag& a, const Flag& b)
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
    EXPECT_EQ(farthest(steady, flag_in(R"(, "turbulence": 0, "seed": 3)")), 0.0);
}

TEST(Wind, GustsMoveClothTheSameWayForASeedAndAnyThreadCount)
{
    const std::string gusty = R"(, "turbulence": 0.4)";
    const Flag one = flag_in(gusty, 1);
    EXPECT_GT(one.gust_calls, 0);
    EXPECT_EQ(farthest(one, flag_in(gusty, 4)), 0.0);
    EXPECT_GT(farthest(one, flag_in("")), 0.01);
    EXPECT_GT(farthest(one, flag_in(gusty + R"(, "seed": 1)")), 0.01);
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

} // namespace
} // namespace toile
