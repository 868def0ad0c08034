#include "apps/toile/drape/continuation.h"

#include <cmath>

#include "apps/toile/drape/drape_files.h"
#include "scenes/format/read_scene.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

/// What the scene of a draped garment plays.
namespace toile::test {

using namespace app;

namespace {

/// A column with the joints `base` and `tip`; its clip "slide" lasts 2 s and begins in the bind pose.
scene::Avatar column()
{
    scene::Avatar body;
    body.name = "body";
    body.shape = std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf";
    return body;
}

/// A clip of 1 s for the column that begins this many centimetres in front of its bind pose.
std::string bvh_in_front(int centimetres)
{
    const std::string root = "0 0 " + std::to_string(centimetres) + " 0 0 0 ";
    return "HIERARCHY\nROOT base\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation "
           "Yrotation Xrotation\nJOINT tip\n{\nOFFSET 0 50 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
           "End Site\n{\nOFFSET 0 50 0\n}\n}\n}\nMOTION\nFrames: 3\nFrame Time: 0.5\n" +
           root + "0 0 0\n" + root + "45 0 0\n" + root + "90 0 0\n";
}

class Continued : public FileTest {
protected:
    /// The scene that a drape writes for it.
    scenes::Scene written(const Continuation& continuation,
                          const std::vector<scene::Elastic>& elastics = {}) const
    {
        scenes::DrapeResult result;
        result.garments.resize(1);
        result.garments[0].name = "g";
        result.garments[0].surface.mesh.positions = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
        result.garments[0].surface.mesh.polygons = {{0, 1, 2}};
        result.scene.cloths.resize(1);
        result.scene.cloths[0].fabric = "cotton";
        result.scene.cloths[0].elastics = elastics;
        DrapeFiles files({"g.json"}, folder_);
        files.write_garment(continuation, result, RunLog(true));
        return scenes::read_scene(files.scene());
    }
};

/// A body from a cache stands in its first sample, and plays from there when asked to.
TEST_F(Continued, HoldsOrPlaysACache)
{
    scene::Avatar body;
    body.name = "body";
    body.shape =
        std::filesystem::path(TOILE_SOURCE_DIR) / "tests/scenes/caches/samples/slide.abc#/slide/slide";
    body.speed = 0.0;
    const scenes::Scene still = written(continuation_of(body, {}));
    EXPECT_EQ(still.avatars.at(0).speed, 0.0);
    EXPECT_EQ(std::get<std::filesystem::path>(still.avatars[0].shape).filename(), "slide");

    ClipOptions play;
    play.clip = "cache";
    const scenes::Scene moving = written(continuation_of(body, play));
    EXPECT_EQ(moving.avatars.at(0).speed, 1.0);
    EXPECT_EQ(moving.avatars[0].clip, "cache");
    EXPECT_TRUE(moving.avatars[0].preroll.from_bind);
    EXPECT_EQ(moving.frames, 1 + int(std::ceil(30.0 * (2.0 * 0.5 + 0.25)))) << "0.5 s, with a ramp of 0.5 s";
}

TEST_F(Continued, StandsStillWithoutAClip)
{
    const scenes::Scene scene = written(continuation_of(column(), {}));
    EXPECT_EQ(scene.avatars.at(0).clip, "");
    EXPECT_FALSE(scene.avatars[0].preroll.from_bind);
    EXPECT_EQ(scene.frames, 60);
}

TEST_F(Continued, KeepsElastics)
{
    EXPECT_TRUE(written(continuation_of(column(), {})).cloths.at(0).elastics.empty());
    const scenes::Scene scene =
        written(continuation_of(column(), {}), {{{0, 1, 2}, 0.7, 12.5}, {{2, 0}, 1.0, 3.0}});
    ASSERT_EQ(scene.cloths.at(0).elastics.size(), 2u);
    EXPECT_EQ(scene.cloths[0].elastics[0].vertices, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(scene.cloths[0].elastics[0].ratio, 0.7);
    EXPECT_EQ(scene.cloths[0].elastics[0].stiffness, 12.5);
    EXPECT_EQ(scene.cloths[0].elastics[1].vertices, (std::vector<int>{2, 0}));
}

/// 0.5 s of blend and 0.5 s of ramp, in which 0.25 s of the clip pass: it ends at 1 + 1.75 s, sample 82.5.
TEST_F(Continued, PlaysAClipOfTheBodyToItsEnd)
{
    const scenes::Scene scene = written(continuation_of(column(), {.clip = "slide"}));
    EXPECT_EQ(scene.avatars.at(0).clip, "slide");
    EXPECT_EQ(scene.avatars[0].preroll.ease, 0.5);
    EXPECT_TRUE(scene.avatars[0].preroll.from_bind);
    EXPECT_EQ(scene.frames, 84);
}

/// Smooth ways of 3 m are 1.5 times as fast as their mean: 4.5 s at 1 m/s. The clip ends in the ramp.
TEST_F(Continued, BlendsIntoAMotionFromFarAtAMetreASecond)
{
    const auto file = temporary_.write("far.bvh", bvh_in_front(300));
    const scenes::Scene scene = written(continuation_of(column(), {.motion = file}));
    ASSERT_TRUE(scene.avatars.at(0).motion);
    EXPECT_EQ(scene.avatars[0].clip, "");
    EXPECT_EQ(scene.avatars[0].motion->file, file);
    EXPECT_EQ(scene.avatars[0].motion->map, "names");
    EXPECT_EQ(scene.avatars[0].preroll.ease, 4.5);
    EXPECT_EQ(scene.frames, 231);
}

TEST_F(Continued, PlaysOneOfTheClipsOfAMotion)
{
    const auto file = std::get<std::filesystem::path>(column().shape);
    const scenes::Scene scene = written(continuation_of(column(), {.clip = "bend", .motion = file}));
    ASSERT_TRUE(scene.avatars.at(0).motion);
    EXPECT_EQ(scene.avatars[0].motion->clip, "bend");
    EXPECT_EQ(scene.frames, 1 + 53) << "1 + 0.75 s";
}

TEST_F(Continued, RefusesClipsThatCannotBePlayed)
{
    scene::Avatar statue;
    statue.shape = temporary_.write("statue.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto near = temporary_.write("near.bvh", bvh_in_front(0));
    const auto far = temporary_.write("far.bvh", bvh_in_front(10000));
    struct Case {
        const scene::Avatar body;
        const ClipOptions options;
        std::vector<std::string> says;
    };
    for (const Case& wrong :
         {Case{statue, {.clip = "walk"}, {"statue.obj: has no clips", "--clip walk", "--motion"}},
          Case{statue, {.motion = near}, {"statue.obj: has no bones"}},
          Case{column(), {.clip = "slid"}, {"did you mean 'slide'?", "'bend'"}},
          Case{column(), {.clip = "x", .motion = near}, {"near.bvh: no clip 'x'"}},
          Case{column(), {.motion = near, .map = "cmuu"}, {"--map cmuu", "did you mean \"cmu\"?"}},
          Case{column(), {.motion = near, .map = "none.json"}, {"none.json"}},
          Case{column(), {.motion = far}, {"far", "takes 150 s", "at most 60 s"}}}) {
        const std::string message = refusal([&] { continuation_of(wrong.body, wrong.options); });
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        for (const std::string& part : wrong.says)
            EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
    }
}

} // namespace
} // namespace toile::test
