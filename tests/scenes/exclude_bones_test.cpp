#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "collision/geometry/surface_edges.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/collision/shapes_for_tests.h"
#include "tests/support/jointed_body.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace avatars;
using namespace collision;
using namespace scenes;

namespace {

/// Square column of tests/avatars: joint "base" below, "tip" from y = 0.5 up.
scene::Avatar column(const std::vector<std::string>& bones)
{
    scene::Avatar avatar;
    avatar.name = "column";
    avatar.shape = std::filesystem::path(TOILE_SOURCE_DIR) / "tests/avatars/bending_column.gltf";
    avatar.clip = "slide";
    avatar.exclude_bones = bones;
    return avatar;
}

TEST(ExcludeBones, LeavesAClosedSurfaceThatMovesWithTheBody)
{
    SceneBody body(column({"tip"}));
    EXPECT_EQ(body.surface().triangle_count(), 20);
    for (const double time : {0.0, 1.0}) {
        body.advance_to(time);
        const TriangleMesh& contact = body.contact_surface();
        EXPECT_TRUE(build_surface_edges(contact.triangles, contact.vertex_count()).is_closed);
        Bounds box; // of the contact surface: vertices of the tip remain, but without triangles
        double volume = 0.0;
        for (const Triangle& t : contact.triangles) {
            const Vec3 &a = contact.positions[t[0]], &b = contact.positions[t[1]],
                       &c = contact.positions[t[2]];
            volume += a.cross(b).dot(c) / 6.0;
            for (const Vec3& x : {a, b, c})
                box.extend(x);
        }
        EXPECT_NEAR(volume, 0.2 * 0.2 * 0.5, 1e-6);
        EXPECT_NEAR(box.upper.y(), 0.5, 1e-6);
        EXPECT_NEAR(box.center().z(), 0.5 * time, 1e-6);
    }
    // Faces are those of the drawn surface, and four of a lid.
    int lids = 0;
    for (int t = 0; t < body.contact_surface().triangle_count(); ++t) {
        if (const int face = body.face_of(t); face >= 0)
            EXPECT_EQ(body.surface().triangles[face], body.contact_surface().triangles[t]);
        else
            ++lids;
    }
    EXPECT_EQ(lids, 4);
}

TEST(ExcludeBones, ChangesNothingForNoBones)
{
    const SceneBody body(column({}));
    EXPECT_EQ(&body.contact_surface(), &body.surface());
    EXPECT_EQ(body.face_of(7), 7);
}

TEST(ExcludeBones, RefusesUnknownBones)
{
    const std::string file = std::get<std::filesystem::path>(column({}).shape).string();
    const auto complaint = [](const scene::Avatar& avatar) {
        return refusal([&] { SceneBody body(avatar); });
    };
    EXPECT_EQ(complaint(column({"top"})),
              "avatar \"column\": exclude_bones: " + file + " has no bone 'top'; the nearest is 'tip'");
    EXPECT_NE(complaint(column({"LeftHand"})).find("it has '"), std::string::npos);
    EXPECT_EQ(complaint(column({"base"})), "avatar \"column\": exclude_bones: leaves no face of the body for "
                                           "contact; name fewer bones, or remove the avatar");

    const TemporaryFolder folder;
    scene::Avatar rigid = column({"tip"});
    rigid.shape = folder.write("body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    rigid.clip = "";
    EXPECT_NE(complaint(rigid).find("has no bones; remove 'tip'"), std::string::npos);
    EXPECT_EQ(refusal([] {
                  (void)parse_scene(R"({"toile": 1, "frames": 1, "cloths": [{"name": "a", "disc": {}}],
                      "avatars": [{"name": "b", "sphere": {}, "exclude_bones": ["tip"]}]})",
                                    "bad.json");
              }),
              "bad.json: avatars[0].exclude_bones: a shape has no bones");
}

/// Lowest vertex of a sheet after falling for a second on a hand above a table [m].
double fall(const std::string& excluded)
{
    const TemporaryFolder folder;
    write_gltf(
        folder.path() / "body.gltf",
        {{"table", testing::box_mesh({-0.3, -0.1, -0.3}, {0.3, 0.0, 0.3})},
         {"arm", testing::box_mesh({0.4, 0.1, -0.1}, {0.6, 0.2, 0.1})},
         {"hand", testing::box_mesh({-0.15, 0.1, -0.15}, {0.15, 0.15, 0.15}), {{0.0}}, Vec3::Zero(), 1}});
    folder.write("scene.json", R"({"toile": 1, "frames": 16, "cloths": [{"name": "sheet",
        "rectangle": {"size": [0.1, 0.1], "resolution": 0.025}, "translate": [0, 0.16, 0]}],
        "avatars": [{"name": "body", "file": "body.gltf", "exclude_bones": )" +
                                   excluded + "}]}");
    World world(read_scene(folder.path() / "scene.json"));
    while (world.frame() + 1 < world.frame_count())
        (void)world.advance_frame();
    double lowest = 1.0;
    for (const Vec3& x : world.cloths()[0].positions)
        lowest = std::min(lowest, x.y());
    return lowest;
}

TEST(ExcludeBones, LetsClothThroughTheBoneAndItsChildren)
{
    EXPECT_NEAR(fall("[]"), 0.151, 0.001);
    for (const char* bones : {"[\"hand\"]", "[\"arm\"]"})
        EXPECT_NEAR(fall(bones), 0.001, 0.001) << bones;
}

TEST(ExcludeBones, CutTheHandsOffARealBody)
{
    scene::Avatar woman;
    woman.name = "woman";
    const std::filesystem::path file = std::filesystem::path(TOILE_DATA_DIR) / "avatars/mh_woman.glb";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no avatars/mh_woman.glb";
    woman.shape = file;
    woman.clip = "walk";
    woman.exclude_bones = {"LeftHand", "RightHand"}; // with the child bones of fingers and thumbs
    SceneBody body(woman);
    body.advance_to(2.0);
    const TriangleMesh& contact = body.contact_surface();
    EXPECT_EQ(contact.vertex_count(), body.surface().vertex_count() + 2); // a lid for each wrist
    EXPECT_TRUE(build_surface_edges(contact.triangles, contact.vertex_count()).is_closed);
    for (int lid = 1; lid <= 2; ++lid) {
        const Vec3& middle = contact.positions[contact.vertex_count() - lid];
        for (const Triangle& t : contact.triangles)
            for (const int v : t)
                if (t[2] == contact.vertex_count() - lid) {
                    EXPECT_LT((contact.positions[v] - middle).norm(), 0.06); // a wrist, not a shoulder
                }
    }
    EXPECT_GT(body.surface().triangle_count(), contact.triangle_count() + 1000);
}

} // namespace
} // namespace toile::test
