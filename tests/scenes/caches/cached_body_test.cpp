#include "tests/scenes/caches/cached_body.h"

#include <cstdio>
#include <cstring>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "collision/check/find_crossings.h"
#include "export/usd/usd_python.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/drape/dressed_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/support/refusal.h"

namespace toile::test {

using testing::HasSubstr;

namespace {

double largest_difference(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    if (a.size() != b.size())
        return std::numeric_limits<double>::infinity();
    double largest = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        largest = std::max(largest, (a[v] - b[v]).norm());
    return largest;
}

std::vector<Vec3> positions_at(SceneBody& body, double t)
{
    body.advance_to(t);
    return body.surface().positions;
}

/// Largest distance of a vertex from the nearest of another mesh [m].
double distance_of_sets(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double largest = 0.0;
    for (const Vec3& x : a) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& y : b)
            nearest = std::min(nearest, (x - y).norm());
        largest = std::max(largest, nearest);
    }
    return largest;
}

class CachedBody : public FileTest {
protected:
    Scene scene(const std::string& avatar, const std::string& more = "") const
    {
        return parse_scene(R"({"toile": 1, "frames": 8, "fps": 32, "avatars": [{"name": "body", )" + avatar +
                               R"(}], "cloths": [{"name": "cloth", "rectangle": {"size": [0.3, 0.3],
            "resolution": 0.05}, "translate": [0, 0.5, 0]}])" +
                               more + "}",
                           file("scene.json"));
    }
    std::string complaint(const std::string& avatar) const
    {
        return refusal([&] { World world(scene(avatar)); });
    }
};

// --- what a body shows ---

TEST_F(CachedBody, ShowsTheSamplesOfEveryFormat)
{
    exports::CacheLayout layout;
    layout.fps = 32.0;
    layout.start_frame = 1001.0; // the first sample is sample 0 of the scene all the same
    write_obj(file("tube.obj"), tube());
    for (const std::string name : {"tube.abc", "tube.pc2", "tube.mdd", "tube_####.obj"}) {
        SCOPED_TRACE(name);
        write_tube(file(name), 6, layout);
        const bool has_faces =
            name.find(".abc") != std::string::npos || name.find(".obj") != std::string::npos;
        const Scene scene =
            this->scene(R"("file": ")" + name + (has_faces ? R"(")" : R"(", "mesh": "tube.obj")"));
        SceneBody body(scene.avatars[0]);
        EXPECT_EQ(body.surface().triangles.size(), 24u * 2 + 4 + 4);
        for (int k = 0; k < 6; ++k)
            EXPECT_LT(largest_difference(positions_at(body, k / 32.0), tube_at(k)), 1e-8) << k;
        EXPECT_EQ(positions_at(body, 9.0), positions_at(body, 5.0 / 32.0)) << "held at its end";
        EXPECT_FALSE(body.is_static());
    }
}

TEST_F(CachedBody, TakesTheRateOfTheSceneOnlyWhereItsFormatHasNone)
{
    write_tube(file("tube_####.obj"), 9);
    exports::CacheLayout layout;
    layout.fps = 24.0;
    layout.subframes = 4;
    write_tube(file("tube.abc"), 9, layout);
    SceneBody sequence(scene(R"("file": "tube_####.obj")").avatars[0]);
    EXPECT_LT(largest_difference(positions_at(sequence, 4 / 32.0), tube_at(4)), 1e-8);
    SceneBody slow(scene(R"("file": "tube_####.obj", "fps": 10)").avatars[0]);
    EXPECT_LT(largest_difference(positions_at(slow, 0.4), tube_at(4)), 1e-8);
    SceneBody archive(scene(R"("file": "tube.abc")").avatars[0]);
    EXPECT_LT(largest_difference(positions_at(archive, 4 / 96.0), tube_at(4)), 1e-8);
}

/// A body that moves at a constant speed does so at any rate of the scene.
TEST_F(CachedBody, MovesEvenlyAtAnyRateOfTheScene)
{
    constexpr double kSpeed = 1.2; // [m/s]
    for (const double fps : {24000.0 / 1001.0, 24.0, 30000.0 / 1001.0}) {
        exports::CacheLayout layout = exports::cache_layout(tube(), 49);
        layout.fps = fps;
        layout.start_frame = 1001.0;
        const auto writer = exports::make_cache_writer(file("run.abc"), layout);
        for (int k = 0; k < 49; ++k) {
            std::vector<Vec3> x = tube().positions;
            for (Vec3& p : x)
                p.x() += kSpeed * k / fps;
            writer->write(k, x);
        }
        writer->finish();
        SceneBody body(cached_avatar(file("run.abc")));
        const double end = 48.0 / fps;
        for (const double scene_fps : {24.0, 24000.0 / 1001.0, 25.0, 30.0, 60.0, 144.0}) {
            const std::vector<Vec3> first = positions_at(body, 0.0);
            double largest = 0.0;
            for (int frame = 0; frame / scene_fps <= end; ++frame) {
                const std::vector<Vec3> x = positions_at(body, frame / scene_fps);
                for (size_t v = 0; v < x.size(); ++v)
                    largest = std::max(largest,
                                       (x[v] - first[v] - Vec3(kSpeed * frame / scene_fps, 0.0, 0.0)).norm());
            }
            EXPECT_LT(largest, 1e-6) << fps << " in a scene of " << scene_fps;
        }
    }
}

/// tests/export/alembic/samples/make_samples.py says what is in it: heights of 1 to 4 m at 0.1, 0.2, 0.7 and
/// 1.7 s, and places of 0, 4 and 5 m at 0, 0.4 and 1 s.
TEST_F(CachedBody, HasSamplesAtTimesOfItsOwn)
{
    const std::string archive = TOILE_SOURCE_DIR "/tests/export/alembic/samples/irregular.abc";
    SceneBody body(cached_avatar(archive + "#/mover/square"));
    const auto corner = [&](double t) { return positions_at(body, t)[2]; };
    EXPECT_LT((corner(0.0) - Vec3(1.0, 1.0, 0.0)).norm(), 1e-12);
    EXPECT_LT((corner(0.15) - Vec3(2.5, 1.5, 0.0)).norm(), 1e-12);
    EXPECT_LT((corner(0.45) - Vec3(1.0 + 4.0 + 0.25 / 3.0, 2.5, 0.0)).norm(), 1e-12);
    EXPECT_LT((corner(1.2) - Vec3(6.0, 3.5, 0.0)).norm(), 1e-12);
    EXPECT_LT((corner(9.0) - Vec3(6.0, 4.0, 0.0)).norm(), 1e-12);
    scene::Avatar slow = cached_avatar(archive + "#/mover/square");
    slow.start = 0.7;
    slow.speed = 0.5;
    SceneBody late(slow);
    EXPECT_LT((positions_at(late, 1.0)[2] - Vec3(6.0, 3.5, 0.0)).norm(), 1e-12);
}

TEST_F(CachedBody, StartsRunsAndRepeatsAsAClip)
{
    exports::CacheLayout layout;
    layout.fps = 32.0;
    write_tube(file("tube.abc"), 9, layout);
    SceneBody late(scene(R"("file": "tube.abc", "start": 0.125, "speed": 0.5)").avatars[0]);
    EXPECT_EQ(positions_at(late, 0.0), tube_at(4));
    EXPECT_EQ(positions_at(late, 2 / 32.0), tube_at(5));
    SceneBody loop(scene(R"("file": "tube.abc", "loop": true)").avatars[0]);
    EXPECT_EQ(positions_at(loop, 10 / 32.0), tube_at(2));
    SceneBody frozen(scene(R"("file": "tube.abc", "start": 0.125, "speed": 0)").avatars[0]);
    EXPECT_TRUE(frozen.is_static());
    EXPECT_EQ(positions_at(frozen, 5.0), tube_at(4));
    SceneBody held(scene(R"("file": "tube.abc", "preroll": {"hold": 1}, "clip": "cache")").avatars[0]);
    EXPECT_EQ(positions_at(held, 1.0), tube_at(0));
    EXPECT_EQ(positions_at(held, 1.0 + 3 / 32.0), tube_at(3));
}

TEST_F(CachedBody, IsPlacedByUnitAxisPlacementAndKeyframes)
{
    write_tube(file("tube.abc"), 2);
    SceneBody body(scene(R"("file": "tube.abc", "unit": "cm", "up": "z", "scale": 50, "translate": [1, 2, 3],
        "keyframes": [{"time": 0}, {"time": 1, "translate": [0, 0, 1]}])")
                       .avatars[0]);
    const auto expected = [](int sample, double z) {
        std::vector<Vec3> x = tube_at(sample);
        for (Vec3& p : x)
            p = 0.5 * Vec3(p.x(), p.z(), -p.y()) + Vec3(1, 2, 3 + z);
        return x;
    };
    EXPECT_LT(largest_difference(positions_at(body, 0.0), expected(0, 0.0)), 1e-15);
    EXPECT_LT(largest_difference(positions_at(body, 2.0), expected(1, 1.0)), 1e-15);
}

TEST_F(CachedBody, OfOneSampleIsStatic)
{
    write_tube(file("tube.abc"), 1);
    SceneBody body(scene(R"("file": "tube.abc")").avatars[0]);
    EXPECT_TRUE(body.is_static());
    EXPECT_EQ(body.surface().positions, tube_at(0));
    EXPECT_THAT(complaint(R"("file": "tube.abc", "loop": true)"), HasSubstr("tube.abc: has one sample"));
}

TEST_F(CachedBody, IsDressedInItsFirstSample)
{
    write_tube(file("tube.abc"), 3);
    const DressedBody body(cached_avatar(file("tube.abc")), false);
    EXPECT_EQ(body.skin.positions, tube_at(0));
    EXPECT_EQ(body.skin.triangles.size(), 56u);
}

// --- from Blender ---

/// Cloth that lies on the ball, is held to it in the middle, and goes along.
std::string carried_by(const std::string& file, const std::string& clip)
{
    return R"({"toile": 1, "frames": 16, "fps": 32, "avatars": [{"name": "body", "file": ")" + file +
           R"(", "clip": ")" + clip + R"("}], "cloths": [{"name": "cloth", "rectangle": {"size": [0.4, 0.4],
        "resolution": 0.04}, "translate": [0, 0.21, 0]}], "attachments": [{"cloth": "cloth", "to": "body",
        "select": {"nearest": [[0, 0.21, 0]]}}], "solver": {"substeps": 4}})";
}

std::vector<std::vector<Vec3>> frames_of(const std::string& text)
{
    World world(parse_scene(text, "baked.json"));
    std::vector<std::vector<Vec3>> frames{world.cloths()[0].positions};
    while (world.frame() + 1 < world.frame_count()) {
        static_cast<void>(world.advance_frame());
        frames.push_back(world.cloths()[0].positions);
    }
    return frames;
}

/// Where Blender's archive and its glTF hold the same numbers, cloth comes out with the same bits.
TEST(BakedBody, MovesClothToTheBitsOfTheGltfWhereTheNumbersAgree)
{
    SceneBody archive(cached_avatar(baked("slide.abc")));
    scene::Avatar settings = cached_avatar(baked("slide.glb"));
    settings.clip = "slideAction";
    SceneBody rigged(settings);
    for (int step = 0; step <= 64; ++step)
        ASSERT_EQ(positions_at(archive, step / 128.0), positions_at(rigged, step / 128.0)) << step;

    const auto from_archive = frames_of(carried_by(baked("slide.abc").string(), "cache"));
    const auto from_gltf = frames_of(carried_by(baked("slide.glb").string(), "slideAction"));
    ASSERT_EQ(from_archive.size(), 16u);
    EXPECT_EQ(from_archive, from_gltf);
    EXPECT_GT(largest_difference(from_gltf.back(), from_gltf.front()), 0.2) << "moved along";
}

/// Blender's USD is Z up, and its archive Y up; both are in metres.
TEST(BakedBody, MovesClothToTheSameBitsFromUsd)
{
    const std::string missing = refusal([] { exports::require_usd_python("USD"); });
    if (!missing.empty())
        GTEST_SKIP() << missing;
    for (const std::string name : {"slide", "bend"}) {
        SceneBody archive(cached_avatar(baked(name + ".abc")));
        SceneBody stage(cached_avatar(baked(name + ".usdc")));
        for (int step = 0; step <= 64; ++step)
            ASSERT_EQ(positions_at(stage, step / 128.0), positions_at(archive, step / 128.0)) << name << step;
    }
    EXPECT_EQ(frames_of(carried_by(baked("slide.usdc").string(), "cache")),
              frames_of(carried_by(baked("slide.abc").string(), "cache")));
}

TEST(BakedBody, PushesClothOutThatStartsInside)
{
    const std::string text =
        R"({"toile": 1, "frames": 4, "fps": 32, "avatars": [{"name": "body", "file": ")" +
        baked("slide.abc").string() + R"("}], "cloths": [{"name": "cloth", "rectangle":
        {"size": [0.4, 0.4], "resolution": 0.04}, "translate": [0, 0.19, 0]}]})";
    World world(parse_scene(text, "baked.json"));
    EXPECT_TRUE(world.start().was_repaired);
    SceneBody body(cached_avatar(baked("slide.abc")));
    for (int frame = 0; frame < world.frame_count(); ++frame) {
        if (frame > 0)
            static_cast<void>(world.advance_frame());
        body.advance_to(frame / 32.0);
        const ClothState& cloth = world.cloths()[0];
        EXPECT_TRUE(collision::find_crossings(cloth.triangles, cloth.positions, body.surface().triangles,
                                              body.surface().positions)
                        .empty())
            << frame;
    }
}

/// Blender skins in single precision, and turns along arcs between keys where a cache is linear.
TEST(BakedBody, FollowsTheRigWithinSinglePrecision)
{
    SceneBody archive(cached_avatar(baked("bend.abc")));
    scene::Avatar settings = cached_avatar(baked("bend.glb"));
    settings.clip = "rigAction";
    SceneBody rigged(settings);
    double at_samples = 0.0, between = 0.0;
    for (int step = 0; step <= 128; ++step) {
        const double distance =
            distance_of_sets(positions_at(archive, step / 256.0), positions_at(rigged, step / 256.0));
        double& largest = step % 8 == 0 ? at_samples : between;
        largest = std::max(largest, distance);
    }
    EXPECT_LT(at_samples, 1e-6);
    EXPECT_LT(between, 1e-3);
    EXPECT_GT(between, at_samples);
    std::printf("bend: %.3g m at samples, %.3g m between\n", at_samples, between);

    // A skirt that hangs on the column. Contact tells bodies apart that differ by less than anybody sees, so
    // the runs part company: 2 cm after half a second.
    const auto skirt = [](const std::string& avatar) {
        return frames_of(R"({"toile": 1, "frames": 16, "fps": 32, "avatars": [{"name": "body", "file": ")" +
                         avatar + R"("}], "cloths": [{"name": "cloth", "skirt": {"waist_radius": 0.1,
            "hem_radius": 0.16, "length": 0.3, "resolution": 0.03}, "translate": [0, 0.75, 0]}], "attachments": [
            {"cloth": "cloth", "to": "body", "select": {"box": {"lower": [-1, 0.745, -1], "upper": [1, 1, 1]}}}],
            "solver": {"substeps": 4}})");
    };
    const auto from_archive = skirt(baked("bend.abc").string());
    const auto from_gltf = skirt(baked("bend.glb").string() + R"(", "clip": "rigAction)");
    double early = 0.0, late = 0.0;
    for (size_t k = 0; k < from_gltf.size(); ++k) {
        double& largest = k <= 8 ? early : late;
        largest = std::max(largest, largest_difference(from_archive[k], from_gltf[k]));
    }
    std::printf("skirt: %.3g m in the first quarter of a second, %.3g m in the second\n", early, late);
    EXPECT_GT(largest_difference(from_gltf.back(), from_gltf.front()), 0.2) << "moved along";
    EXPECT_LT(early, 5e-3);
}

// --- refusals ---

TEST_F(CachedBody, IsRefusedWithTheRemedy)
{
    write_obj(file("tube.obj"), tube());
    ObjMesh less = tube();
    less.positions.push_back(Vec3::Zero());
    write_obj(file("other.obj"), less);
    write_tube(file("tube.abc"), 3);
    write_tube(file("tube.pc2"), 3);
    temporary_.write("old.abc", "\x89HDF\r\n\x1a\n" + std::string(600, 'x'));

    exports::CacheLayout two = exports::cache_layout(tube(), 1);
    two.meshes.push_back(two.meshes[0]);
    two.meshes[0].name = "left";
    two.meshes[1].name = "right";
    const auto writer = exports::make_cache_writer(file("two.abc"), two);
    writer->write(0, std::vector<Vec3>(60, Vec3::Zero()));
    writer->finish();

    const std::pair<std::string, std::string> cases[] = {
        {R"("file": "none.abc#/a")", R"(avatars[0].file: the file ")"},
        {R"("file": "none_####.obj")", R"(avatars[0].file: no file of the sequence ")"},
        {R"("file": "tube.abc#/other")", "has no mesh /other; its meshes are /tube/tubeShape"},
        {R"("file": "two.abc")", "has several meshes; name one behind #: /left/leftShape, /right/rightShape"},
        {R"("file": "two.abc#/left/leftShape")", "no triangle has an area"},
        {R"("file": "old.abc")", "is an Alembic archive of the old HDF5 kind; convert it"},
        {R"("file": "tube.pc2")", R"(avatars[0]: the key "mesh" is missing; "tube.pc2" has no faces)"},
        {R"("file": "tube.pc2", "mesh": "other.obj")", "has 31 vertices, but"},
        {R"("file": "tube.abc", "mesh": "tube.obj")", R"(avatars[0].mesh: "tube.abc" has faces of its own)"},
        {R"("file": "tube.abc", "fps": 24)", R"(avatars[0].fps: "tube.abc" has times of its own)"},
        {R"("file": "tube.obj", "fps": 24)", "avatars[0].fps: only a cache"},
        {R"("file": "tube.abc", "clip": "walk")", "no clip 'walk'; It has 'cache'"},
        {R"("file": "tube.abc", "exclude_bones": ["hand"])", "has no bones"},
        {R"("file": "tube.abc", "motion": {"file": "a.bvh"})", "avatars[0].motion: a cache has no bones"},
        {R"("file": "tube.abc", "accumulate_root": true)", "avatars[0].accumulate_root: a cache has no root"},
        {R"("file": "tube.abc", "start": 9)", "is after the end of clip 'cache'"},
        {R"("sphere": {}, "up": "z")", "avatars[0].up: only a file has an upward axis"},
    };
    for (const auto& [avatar, expected] : cases)
        EXPECT_THAT(complaint(avatar), HasSubstr(expected)) << avatar;
}

TEST_F(CachedBody, IsRefusedIfItsMeshChanges)
{
    EXPECT_THAT(complaint(R"("file": ")" + baked("growing.abc").string() + R"(")"),
                HasSubstr("changes its faces; a cache needs a mesh of constant topology"));
    ObjMesh more = tube();
    write_obj(file("tube_0000.obj"), more);
    more.positions.push_back(Vec3::Zero());
    write_obj(file("tube_0001.obj"), more);
    const std::string said = refusal([&] {
        World world(scene(R"("file": "tube_####.obj")"));
        static_cast<void>(world.advance_frame());
    });
    EXPECT_THAT(said, HasSubstr("all frames of a sequence need the same mesh"));
}

TEST_F(CachedBody, IsRefusedWhereItsTimesDoNotIncrease)
{
    write_tube(file("tube.mdd"), 3);
    write_obj(file("tube.obj"), tube());
    temporary_.write("tube.mdd", bytes_of(file("tube.mdd")).replace(8, 12, std::string(12, '\0')));
    EXPECT_THAT(complaint(R"("file": "tube.mdd", "mesh": "tube.obj")"),
                HasSubstr("tube.mdd: sample 1 is at 0 s and the one before at 0 s; times must increase"));
}

TEST_F(CachedBody, NamesTheSampleThatIsNoNumber)
{
    write_tube(file("tube.pc2"), 3);
    write_obj(file("tube.obj"), tube());
    std::string bytes = bytes_of(file("tube.pc2"));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&bytes[32 + 12 * 30 + 12 * 7], &nan, sizeof nan); // vertex 7 of sample 1
    temporary_.write("tube.pc2", bytes);
    const std::string said = refusal([&] {
        World world(scene(R"("file": "tube.pc2", "mesh": "tube.obj")"));
        static_cast<void>(world.advance_frame());
    });
    EXPECT_THAT(said, HasSubstr("tube.pc2: vertex 7 of sample 1 is at (nan, "));
}

/// The scene has 8 frames at 32 a second: it ends at 0.219 s.
TEST_F(CachedBody, WarnsWhereItStandsStillBeforeTheSceneEnds)
{
    exports::CacheLayout layout;
    layout.fps = 32.0;
    write_tube(file("short.abc"), 5, layout);
    write_tube(file("whole.abc"), 8, layout);
    write_tube(file("still.abc"), 1, layout);
    const auto warnings = [&](const std::string& avatar) {
        std::string all;
        WorldOptions options;
        options.warn = [&](const std::string& text) { all += text; };
        const World world(scene(avatar), options);
        return all;
    };
    EXPECT_THAT(warnings(R"("file": "short.abc")"),
                HasSubstr("short.abc: ends at 0.125 s, and the scene at 0.219 s; it is held there"));
    EXPECT_THAT(warnings(R"("file": "whole.abc", "start": 0.125)"), HasSubstr("ends at 0.0938 s"));
    EXPECT_THAT(warnings(R"("file": "whole.abc", "preroll": {"hold": 1})"),
                HasSubstr("does not move, for its preroll holds it for 1 s, and the scene ends at 0.219 s"));
    EXPECT_THAT(warnings(R"("file": "still.abc", "preroll": {"hold": 0.1})"),
                HasSubstr("still.abc: shows one pose, so its preroll has no effect"));
    for (const std::string meant :
         {R"("file": "whole.abc")", R"("file": "short.abc", "loop": true)",
          R"("file": "short.abc", "speed": 0)", R"("file": "short.abc", "speed": 0.5)",
          R"("file": "short.abc", "preroll": {"hold": 0.1})", R"("file": "still.abc")"})
        EXPECT_EQ(warnings(meant), "") << meant;
}

TEST_F(CachedBody, WarnsOfAUnitThatMakesItAGiant)
{
    exports::CacheLayout layout = exports::cache_layout(tube(), 1);
    const auto writer = exports::make_cache_writer(file("giant.abc"), layout);
    std::vector<Vec3> x = tube_at(0);
    for (Vec3& p : x)
        p *= 400.0;
    writer->write(0, x);
    writer->finish();
    std::string warnings;
    WorldOptions options;
    options.warn = [&](const std::string& text) { warnings += text; };
    const World world(scene(R"("file": "giant.abc", "translate": [0, 0, 500])"), options);
    EXPECT_THAT(warnings,
                HasSubstr(R"(giant.abc: is 240 m long; if its lengths are in cm, write "unit": "cm")"));
}

} // namespace

} // namespace toile::test
