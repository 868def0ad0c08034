#include <gtest/gtest.h>

#include <filesystem>
#include <set>
#include <string>

#include "core/base/stages.h"
#include "scenes/colliders/collider.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"

namespace toile::test {

using namespace avatars;
using namespace collision;
using namespace scenes;

namespace {

/// Square column of tests/avatars, 1 m high, whose tip bends for a second.
scene::Avatar bending_column()
{
    scene::Avatar avatar;
    avatar.name = "column";
    avatar.shape = std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf";
    avatar.clip = "bend";
    avatar.self_contact = scene::SelfContact::Keep;
    return avatar;
}

std::vector<Vec3> copy_of(View<const Vec3> x) { return {x.begin(), x.end()}; }

TEST(SkinnedCollider, GrowsWithTheBlendShapesOfItsFile)
{
    // Vertex 1 moves along X by half of the weight, which goes from 0.25 to 2 in a second.
    scene::Avatar settings;
    settings.name = "body";
    settings.shape = std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/growing_tetrahedron.gltf";
    settings.clip = "grow";
    SkinnedCollider body(settings, identity_affine());
    std::vector<Vec3> x(4);
    body.pose_t1(x);
    EXPECT_NEAR(x[1].x(), 1.125, 1e-12);
    EXPECT_TRUE(body.advance_to(1.0, identity_affine()));
    body.pose_t0(x);
    EXPECT_NEAR(x[1].x(), 1.125, 1e-12);
    body.pose_t1(x);
    EXPECT_NEAR(x[1].x(), 2.0, 1e-12);
    EXPECT_NEAR(body.vertex_t1(1).x(), 2.0, 1e-12);
}

TEST(SkinnedCollider, GivesSingleVerticesAndLidsLikeTheWholePose)
{
    scene::Avatar settings = bending_column();
    settings.exclude_bones = {"tip"};
    SkinnedCollider skinned(settings, identity_affine());
    EXPECT_GT(skinned.vertex_count(), skinned.body_vertex_count());
    EXPECT_TRUE(skinned.advance_to(0.4, identity_affine()));
    std::vector<Vec3> x(size_t(skinned.vertex_count()));
    skinned.pose_t1(x);
    for (int v = 0; v < skinned.vertex_count(); ++v)
        EXPECT_LT((skinned.vertex_t1(v) - x[size_t(v)]).norm(), 1e-15) << v;
}

TEST(SkinnedCollider, FindsTheBoneNearAPoint)
{
    SkinnedCollider column(bending_column(), identity_affine());
    EXPECT_TRUE(column.advance_to(0.5, identity_affine()));
    std::set<std::string> bones;
    for (int v = 0; v < column.body_vertex_count(); ++v) {
        const Vec3 beside = column.vertex_t1(v) + Vec3(0.001, 0.001, 0.001);
        EXPECT_EQ(column.nearest_vertex(beside, 0.01), v);
        bones.insert(column.avatar().bone_at(v));
    }
    EXPECT_EQ(bones, (std::set<std::string>{"base", "tip"}));
    EXPECT_EQ(column.nearest_vertex({0.0, 5.0, 0.0}, 0.1), -1);
}

/// Tests on the clip of the body's own file are of a motion from another file too.
TEST(SkinnedCollider, PlaysAMotionFromAnotherFileLikeItsOwnClip)
{
    scene::Avatar own = bending_column(), other = bending_column();
    other.clip.clear();
    other.motion = {std::get<std::filesystem::path>(own.shape), "bend", "names"};
    for (scene::Avatar* avatar : {&own, &other}) {
        avatar->start = 0.2;
        avatar->speed = 0.5;
        avatar->preroll = {0.1, 0.2, true};
        avatar->translate = Vec3(1.0, 0.0, 0.0);
    }
    SkinnedCollider a(own, identity_affine()), b(other, identity_affine());
    std::vector<Vec3> x(size_t(a.vertex_count())), y(x.size());
    for (const double t : {0.0, 0.15, 0.3, 0.45, 0.8}) {
        EXPECT_EQ(a.advance_to(t, identity_affine()), b.advance_to(t, identity_affine()));
        a.pose_t1(x);
        b.pose_t1(y);
        for (size_t v = 0; v < x.size(); ++v)
            EXPECT_LT((x[v] - y[v]).norm(), 1e-12) << v << " at " << t;
    }
}

/// A strap that is stretched between attachments beside the column's tip.
TEST(SkinnedCollider, IsNamedWithItsBoneWhereClothYields)
{
    const std::string file =
        (std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf").string();
    World world(parse_scene(R"({"toile": 1, "frames": 2, "gravity": [0, 0, 0],
        "avatars": [{"name": "column", "file": ")" +
                                file + R"(", "clip": "bend"}],
        "cloths": [{"name": "strap", "rectangle": {"size": [0.16, 0.1], "resolution": 0.04},
            "translate": [0, 1.05, 0]}],
        "attachments": [{"cloth": "strap", "select": {"box": {"lower": [-0.09, 0, -1], "upper": [-0.07, 2, 1]}}},
            {"cloth": "strap", "select": {"box": {"lower": [0.07, 0, -1], "upper": [0.09, 2, 1]}},
             "keyframes": [{"time": 0}, {"time": 0.03, "translate": [0.1, 0, 0]}]}]})",
                            "strap.json"));
    const StepReport report = world.advance_frame();
    ASSERT_GT(report.yielded.count, 0);
    EXPECT_NE(report.yielded.place.find("\"strap\""), std::string::npos) << report.yielded.place;
    EXPECT_NE(report.yielded.place.find(", by \"tip\" of \"column\""), std::string::npos)
        << report.yielded.place;
}

TEST(SkinnedCollider, IsSkinnedOnDemand)
{
    Collider avatar(bending_column(), 0.3);
    const MeshCollider& collider = *avatar.contact_collider().mesh;
    Stages stages;
    const Stages::Activate recording(stages);
    for (const double t : {0.1, 0.2, 0.3})
        avatar.advance_to(t);
    EXPECT_TRUE(collider.is_moving());
    EXPECT_EQ(collider.move_count(), 3);
    EXPECT_EQ(stages.calls("avatars/skin"), 0);

    const std::vector<Vec3> end = copy_of(collider.x_t1());
    EXPECT_EQ(stages.calls("avatars/skin"), 2) << "both ends of the step";
    EXPECT_NE(copy_of(collider.x_t0()), end);
    EXPECT_EQ(copy_of(collider.surface().positions()), end);
    EXPECT_EQ(stages.calls("avatars/skin"), 2);
    EXPECT_EQ(stages.calls("collision/refit"), 1);

    avatar.advance_to(0.4);
    EXPECT_EQ(copy_of(collider.x_t0()), end);
    EXPECT_NE(copy_of(collider.x_t1()), end);
}

TEST(SkinnedCollider, BoundsTheMotionSinceTheLastQuery)
{
    Collider avatar(bending_column(), 0.3);
    const MeshCollider& collider = *avatar.contact_collider().mesh;
    avatar.advance_to(0.1);
    const std::vector<Vec3> before = copy_of(collider.x_t1());
    for (const double t : {0.2, 0.3})
        avatar.advance_to(t);
    for (int v = 0; v < collider.x_t1().size(); ++v) {
        const Vec3 moved = collider.x_t1()[v] - before[size_t(v)];
        const Bounds* const motion = collider.last_motion().view().around(collider.x_t1()[v]);
        ASSERT_NE(motion, nullptr);
        EXPECT_TRUE((moved.array() >= motion->lower.array()).all() &&
                    (moved.array() <= motion->upper.array()).all())
            << v;
    }
}

TEST(SkinnedCollider, StopsWhereItsClipEnds)
{
    Collider avatar(bending_column(), 0.3);
    const MeshCollider& collider = *avatar.contact_collider().mesh;
    for (const double t : {0.9, 1.0, 1.1})
        avatar.advance_to(t);
    EXPECT_FALSE(avatar.moved());
    EXPECT_FALSE(collider.is_moving());
    EXPECT_EQ(collider.move_count(), 2);
    EXPECT_EQ(copy_of(collider.x_t0()), copy_of(collider.x_t1()));
    const std::vector<Vec3> end = copy_of(collider.x_t1());
    Collider bent(bending_column(), 0.3);
    bent.advance_to(1.0);
    EXPECT_EQ(copy_of(bent.contact_collider().mesh->x_t1()), end);
}

TEST(SkinnedCollider, FollowsItsKeyframes)
{
    scene::Avatar settings = bending_column();
    settings.clip = "";
    scene::Keyframe raised;
    raised.time = 1.0;
    raised.translate = {0.0, 0.5, 0.0};
    settings.keyframes = {scene::Keyframe{}, raised};
    Collider avatar(settings, 0.3);
    const MeshCollider& collider = *avatar.contact_collider().mesh;
    const std::vector<Vec3> start = copy_of(collider.x_t1());
    avatar.advance_to(0.5);
    EXPECT_TRUE(avatar.moved());
    for (size_t v = 0; v < start.size(); ++v)
        EXPECT_LT((collider.x_t1()[int(v)] - start[v] - Vec3(0, 0.25, 0)).norm(), 1e-15);
    avatar.advance_to(1.0);
    avatar.advance_to(1.5);
    EXPECT_FALSE(avatar.moved()) << "cloth on it may sleep";
}

} // namespace
} // namespace toile::test
