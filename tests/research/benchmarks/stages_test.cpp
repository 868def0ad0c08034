#include <gtest/gtest.h>

#include <algorithm>

#include "research/benchmarks/stages/table.h"
#include "scenes/format/read_scene.h"

namespace toile::research::stages {
namespace {

/// Small cloth that falls onto a ball.
scenes::Scene small_scene()
{
    return scenes::parse_scene(R"({ "toile": 1, "name": "Ball, small", "frames": 12,
        "avatars": [ { "name": "ball", "sphere": { "radius": 0.1 } } ],
        "cloths": [ { "name": "cloth", "rectangle": { "size": [0.3, 0.3], "resolution": 0.03 },
                      "translate": [0, 0.105, 0] } ] })",
                               "small.json");
}

TEST(StagesBenchmark, CountsFramesIterationsContactsAndTime)
{
    int frames = 0;
    const Result result = run(small_scene(), [&](int frame) { return frame == ++frames; });
    EXPECT_EQ(frames, 11);
    EXPECT_EQ(result.frames, 11);
    EXPECT_EQ(result.vertices, 121);
    EXPECT_GT(result.iterations, 0.0);
    EXPECT_GT(result.contacts, 0.0);
    EXPECT_GT(result.peak_memory, 1000000);

    // The whole step comes first, and no stage is longer than its frame.
    ASSERT_FALSE(result.stages.empty());
    EXPECT_EQ(result.stages.front().name, "scenes/step");
    for (size_t i = 0; i < result.stages.size(); ++i) {
        EXPECT_LE(result.stages[i].fraction, 1.0);
        EXPECT_GE(result.stages[i].fraction, kMinStageFraction);
        EXPECT_LE(result.stages[i].ms, result.stages[i > 0 ? i - 1 : 0].ms);
    }
}

TEST(StagesTable, HasARowPerSceneAndPerStage)
{
    Result result;
    result.name = "Ball, small";
    result.frames = 11;
    result.peak_memory = 3l << 20;
    result.stages = {{"scenes/step", 4.0, 2.0, 0.99}, {"pd/minimise", 4.0, 1.0, 0.5}};
    EXPECT_EQ(csv_of_stages({result}), "scene,stage,calls_per_frame,ms_per_frame,share\n"
                                       "\"Ball, small\",scenes/step,4.0,2.00,0.990\n"
                                       "\"Ball, small\",pd/minimise,4.0,1.00,0.500\n");
    const std::string scenes = csv_of_scenes({result});
    EXPECT_EQ(std::count(scenes.begin(), scenes.end(), '\n'), 2);
    EXPECT_EQ(scenes.substr(scenes.rfind(',')), ",3\n");
    const std::string tables = markdown_tables({result});
    EXPECT_EQ(std::count(tables.begin(), tables.end(), '\n'), 3 + 1 + 4);
}

} // namespace
} // namespace toile::research::stages
