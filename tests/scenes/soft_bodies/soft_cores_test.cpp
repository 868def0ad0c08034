#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include <nlohmann/json.hpp>

#include "scenes/colliders/core_constraint.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/world_crossings.h"
#include "tests/avatars/column.h"
#include "tests/scenes/caches/cached_body.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"
#include "tests/volume/blocks.h"
#include "volume/mesh/msh.h"

namespace toile::test {

using namespace scenes;

namespace {

const std::string kColumn =
    R"({"name": "column", "file": ")" + column_file().string() + R"(", "clip": "bend"})";
const std::string kFilled =
    R"({"name": "flesh", "core": {"avatar": "column", "depth": 0.04}, "cell": 0.06, "young": 2e4})";

class SoftCores : public testing::Test {
protected:
    /// A block of edge 0.1 m and a flat box around its lower half: the two lowest of five layers of vertices
    /// are 1.5 cm deep.
    SoftCores()
    {
        write_msh(folder.path() / "block.msh", make_block(Vec3::Constant(0.1), {4, 4, 4}, 0.1).mesh);
        std::ofstream(folder.path() / "box.obj")
            << "v -0.02 -0.02 -0.02\nv 0.12 -0.02 -0.02\nv 0.12 0.05 -0.02\nv -0.02 0.05 -0.02\n"
               "v -0.02 -0.02 0.12\nv 0.12 -0.02 0.12\nv 0.12 0.05 0.12\nv -0.02 0.05 0.12\n"
               "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 1 5 8 4\n";
    }

    Scene scene_of(const std::string& keys) const
    {
        return parse_scene(R"({"toile": 1, )" + keys + "}", folder.path() / "test.json");
    }
    /// The block on the box, which moves by keyframes.
    Scene block_scene(const std::string& keys, const std::string& keyframes = "[]",
                      const std::string& core = R"({"avatar": "box", "depth": 0.015})") const
    {
        return scene_of(keys + R"(, "avatars": [{"name": "box", "file": "box.obj", "keyframes": )" +
                        keyframes + R"(}], "soft_bodies": [{"name": "jelly", "file": "block.msh",
            "young": 5e3, "density": 200, "core": )" +
                        core + "}]");
    }
    std::string refusal_of(const std::string& keys) const
    {
        return refusal([&] { World(scene_of(keys)); });
    }
    TemporaryFolder folder;
};

TEST_F(SoftCores, MoveWithTheirAvatarAndTheRestLags)
{
    const std::string keyframes = R"([{"time": 0}, {"time": 0.15, "translate": [0.1, 0, 0],
        "rotate_deg": [0, 20, 0]}, {"time": 0.3, "translate": [0.1, 0.05, 0.1], "rotate_deg": [20, 40, 0]}])";
    const Scene scene = block_scene(R"("frames": 10, "cloths": [])", keyframes);
    const RigidMotion motion(scene.avatars[0].keyframes, Vec3::Zero());
    World world(scene);
    const std::vector<Vec3> start = world.surfaces()[0].positions;
    double lag = 0.0;
    for (int frame = 1; frame < 10; ++frame) {
        EXPECT_EQ(world.advance_frame().unfinished, 0);
        int held = 0;
        for (size_t v = 0; v < start.size(); ++v) {
            const Vec3 rigid = motion.at(frame / 30.0) * start[v];
            const double off = (world.surfaces()[0].positions[v] - rigid).norm();
            if (start[v].y() > 0.03) {
                lag = std::max(lag, off);
                continue;
            }
            EXPECT_LT(off, 1e-14) << "vertex " << v << " of frame " << frame;
            ++held;
        }
        EXPECT_EQ(held, 25 + 16);
        EXPECT_EQ(world.inverted_tets(), std::vector<int>{0});
        EXPECT_EQ(crossing_count(world), 0);
    }
    EXPECT_GT(lag, 0.003);
}

TEST_F(SoftCores, SayThatTheyHaveJumpedFromUnderCloth)
{
    const auto worst = [&](const std::string& time) {
        World world(
            block_scene(R"("frames": 6, "cloths": [{"name": "blanket", "translate": [0.05, 0.11, 0.05],
            "rectangle": {"size": [0.2, 0.2], "resolution": 0.03}, "fabric": "silk"}])",
                        R"([{"time": 0.1}, {"time": )" + time + R"(, "translate": [0, -0.5, 0]}])"));
        StepReport report;
        for (int frame = 1; frame < 6; ++frame)
            report.merge(world.advance_frame());
        return report;
    };
    const StepReport jump = worst("0.1002");
    EXPECT_EQ(jump.status, StepReport::Status::Stuck);
    EXPECT_NE(jump.stuck.place.find("faster than 50 m/s"), std::string::npos) << jump.stuck.place;
    EXPECT_LT(worst("0.15").status, StepReport::Status::Stuck);
}

TEST_F(SoftCores, ReplaceTheirAvatarInContact)
{
    // The blanket hangs over the edges of the block, past the top of the wider box.
    World world(block_scene(R"("frames": 20, "cloths": [{"name": "blanket", "translate": [0.05, 0.105, 0.05],
        "rectangle": {"size": [0.26, 0.26], "resolution": 0.02}, "fabric": "silk"}])"));
    for (int frame = 1; frame < 20; ++frame)
        EXPECT_EQ(world.advance_frame().unfinished, 0);
    double lowest = 1.0;
    for (const Vec3& x : world.surfaces()[0].positions)
        lowest = std::min(lowest, x.y());
    EXPECT_LT(lowest, 0.04);
    EXPECT_EQ(crossing_count(world), 0);
    EXPECT_TRUE(make_bodies(block_scene(R"("frames": 1, "cloths": [])")).empty());
}

TEST_F(SoftCores, AreBoundAsTheSkinAboveThemIs)
{
    // Points just below the vertices of the skin stay there, and one above it is not in the core.
    const Scene scene = scene_of(R"("frames": 2, "cloths": [], "avatars": [)" + kColumn + R"(],
        "soft_bodies": [)" + kFilled +
                                 "]");
    std::vector<Collider> colliders;
    colliders.emplace_back(scene.avatars[0], 0.3);
    const SkinnedCollider& column = *colliders[0].body().skinned();
    std::vector<Vec3> points{Vec3(0.0, 2.0, 0.0)};
    for (int v = 0; v < column.body_vertex_count(); ++v)
        points.push_back(column.vertex_t1(v) + 1e-7 * (Vec3(0.0, 0.5, 0.0) - column.vertex_t1(v)));
    CoreConstraint core({"column", 0.0, {}}, points, colliders, "here");
    ASSERT_EQ(int(core.vertices().size()), column.body_vertex_count());
    for (const double t : {0.0, 0.4, 1.0}) {
        colliders[0].advance_to(t);
        core.follow(colliders);
        for (int v = 0; v < column.body_vertex_count(); ++v) {
            EXPECT_EQ(core.vertices()[size_t(v)], v + 1);
            EXPECT_LT((core.target(v) - column.vertex_t1(v)).norm(), 1e-6) << v << " at " << t;
        }
    }
}

TEST_F(SoftCores, HaveNoSoftLayerAtRigidBones)
{
    const Scene scene = scene_of(R"("frames": 1, "cloths": [], "avatars": [)" + kColumn + R"(],
        "soft_bodies": [)" + kFilled +
                                 "]");
    std::vector<Collider> colliders;
    colliders.emplace_back(scene.avatars[0], 0.3);
    const std::vector<Vec3> points{
        {0.099, 0.2, 0.0}, {0.0, 0.2, 0.0}, {0.099, 0.9, 0.0}, {0.101, 0.9, 0.0}, {0.0, 0.9, 0.0}};
    EXPECT_EQ(CoreConstraint({"column", 0.05, {}}, points, colliders, "here").vertices(),
              (std::vector<int>{1, 4}));
    EXPECT_EQ(CoreConstraint({"column", 0.05, {"tip"}}, points, colliders, "here").vertices(),
              (std::vector<int>{1, 2, 3, 4}));
    EXPECT_NE(refusal([&] {
                  CoreConstraint({"column", 0.05, {"top"}}, points, colliders, "here");
              }).find("here.rigid_bones"),
              std::string::npos);
}

TEST_F(SoftCores, FollowCachesAsTheyDoRigs)
{
    // A column that bends by 60 degrees in half a second.
    std::vector<Vec3> points{Vec3(0.0, 2.0, 0.0)};
    for (int k = 0; k < 16; ++k)
        points.push_back(Vec3(0.03 * (k % 2), 0.05 * k + 0.025, 0.0));
    const auto core_at_end = [&](const std::string& file, const std::string& clip) {
        scene::Avatar column;
        column.name = "column";
        column.shape = baked(file);
        column.clip = clip;
        std::vector<Collider> colliders;
        colliders.emplace_back(column, 0.3);
        CoreConstraint core({"column", 0.01, {}}, points, colliders, "here");
        colliders[0].advance_to(0.5);
        core.follow(colliders);
        std::vector<Vec3> targets;
        for (size_t k = 0; k < core.vertices().size(); ++k)
            targets.push_back(core.target(int(k)));
        return targets;
    };
    const std::vector<Vec3> cache = core_at_end("bend.abc", ""), rig = core_at_end("bend.glb", "rigAction");
    ASSERT_EQ(rig.size(), 16u);
    ASSERT_EQ(cache.size(), 16u);
    for (size_t k = 0; k < rig.size(); ++k) {
        const bool is_by_joint = std::abs(points[k + 1].y() - 0.4) < 0.15; // turns are means there
        EXPECT_LT((cache[k] - rig[k]).norm(), is_by_joint ? 0.015 : 0.003) << points[k + 1].transpose();
    }
    EXPECT_GT((rig.back() - points.back()).norm(), 0.3);
}

TEST_F(SoftCores, FillTheSurfaceOfTheirAvatar)
{
    const Scene scene = scene_of(R"("frames": 8, "cloths": [], "avatars": [)" + kColumn + R"(],
        "soft_bodies": [)" + kFilled +
                                 "]");
    World world(scene);
    const ClothState& surface = world.surfaces()[0];
    const Bounds box = bounds(surface.positions);
    EXPECT_NEAR((box.upper - Vec3(0.1, 1.0, 0.1)).norm(), 0.0, 1e-6);
    EXPECT_NEAR((box.lower - Vec3(-0.1, 0.0, -0.1)).norm(), 0.0, 1e-6);
    EXPECT_EQ(load_surfaces(scene)[0].positions, surface.positions);
    for (int frame = 1; frame < 8; ++frame)
        EXPECT_EQ(world.advance_frame().unfinished, 0);
    EXPECT_EQ(world.inverted_tets(), std::vector<int>{0});
    EXPECT_LT(bounds(world.surfaces()[0].positions).lower.x(), -0.2) << "the tip turns by 21 degrees";
}

TEST_F(SoftCores, CarryFleshThatSwingsInADress)
{
    Scene scene = read_scene(std::filesystem::path(TOILE_SOURCE_DIR) / "scenes/details/soft_figure.json");
    World world(scene);
    ASSERT_EQ(world.surfaces()[1].name, "flesh");
    std::vector<Collider> colliders;
    for (const scene::Avatar& avatar : scene.avatars)
        colliders.emplace_back(avatar, scene.contact.friction);
    CoreConstraint skin({"figure", 0.0, {}}, world.surfaces()[1].positions, colliders, "here");
    double lag = 0.0;
    for (int frame = 1; frame < 8; ++frame) {
        EXPECT_EQ(world.advance_frame().unfinished, 0);
        EXPECT_EQ(crossing_count(world), 0) << frame;
        EXPECT_EQ(world.inverted_tets(), std::vector<int>{0}) << frame;
        colliders[0].advance_to(frame / scene.fps);
        skin.follow(colliders);
        for (size_t k = 0; k < skin.vertices().size(); ++k)
            lag = std::max(
                lag,
                (world.surfaces()[1].positions[size_t(skin.vertices()[k])] - skin.target(int(k))).norm());
    }
    EXPECT_GT(lag, 0.005);
}

TEST_F(SoftCores, AreRefusedWithTheReason)
{
    const auto of_block = [&](const std::string& core) {
        return refusal([&] { World(block_scene(R"("frames": 1, "cloths": [])", "[]", core)); });
    };
    EXPECT_EQ(of_block(R"({"avatar": "box"})"), "") << "0.02 m is deep enough for the lowest layer";
    EXPECT_NE(of_block(R"({"avatar": "bix"})").find("did you mean \"box\""), std::string::npos);
    EXPECT_NE(of_block(R"({"avatar": "box", "depth": -1})").find("soft_bodies[0].core.depth"),
              std::string::npos);
    const std::string deep = of_block(R"({"avatar": "box", "depth": 0.05})");
    EXPECT_NE(deep.find("soft_bodies[0].core: no vertex is 0.05 m below the surface of \"box\""),
              std::string::npos);
    EXPECT_NE(deep.find("the deepest is at 0.02"), std::string::npos) << deep;

    const auto with = [&](const std::string& avatar, const std::string& body) {
        return refusal_of(R"("frames": 1, "cloths": [], "avatars": [{"name": "a", )" + avatar +
                          R"(}], "soft_bodies": [{"name": "s", )" + body + "}]");
    };
    const std::string core = R"("core": {"avatar": "a"})";
    EXPECT_NE(with(R"("sphere": {})", core + R"(, "cell": 0.05)").find("\"a\" is a shape"),
              std::string::npos);
    EXPECT_NE(with(R"("file": "box.obj")", core).find("\"cell\": 0.02"), std::string::npos);
    EXPECT_NE(with(R"("file": "box.obj")", core + R"(, "cell": 0.05, "scale": 2)").find("[0].scale"),
              std::string::npos);
    EXPECT_NE(with(R"("file": "box.obj")", R"("cell": 0.05)").find("has no file"), std::string::npos);
    EXPECT_NE(with(R"("file": "box.obj", "friction": 1)", core + R"(, "cell": 0.05)")
                  .find("avatars[0].friction: soft body \"s\" is in contact instead of \"a\""),
              std::string::npos);
    EXPECT_NE(with(R"("file": "box.obj", "scale": 100)", R"("core": {"avatar": "a", "depth": 0},
                  "file": "block.msh", "translate": [0, -1, 0])")
                  .find("nothing is soft"),
              std::string::npos);
    EXPECT_NE(with(R"("file": "box.obj")", R"("core": {"avatar": "a"}, "file": "block.msh",
                  "translate": [3, 0, 0])")
                  .find("move the body to where the avatar starts"),
              std::string::npos);
}

TEST_F(SoftCores, ShareNoVertexWithAnAttachment)
{
    const auto of_box = [&](const std::string& lower, const std::string& keys) {
        return refusal([&] {
            World(block_scene(R"("frames": 1, "cloths": [], "attachments": [{"cloth": "jelly",
                "select": {"box": {"lower": [-1, )" +
                              lower + R"(, -1], "upper": [1, 1, 1]}})" + keys + "}]"));
        });
    };
    EXPECT_EQ(of_box("0.09", ""), "");
    for (const char* keys : {"", R"(, "stiffness": 100)"}) {
        const std::string message = of_box("0.01", keys);
        EXPECT_NE(message.find("test.json: attachments[0]: selects the vertex at ("), std::string::npos)
            << message;
        EXPECT_NE(message.find("m of \"jelly\" and 24 more, which "), std::string::npos) << message;
        EXPECT_NE(message.find("test.json: soft_bodies[0].core holds already"), std::string::npos) << message;
    }
}

TEST_F(SoftCores, NeedBonesThatAreNotFlatAtTheStart)
{
    std::stringstream content;
    content << std::ifstream(column_file()).rdbuf();
    nlohmann::json column = nlohmann::json::parse(content.str());
    column["nodes"][2]["scale"] = {1.0, 1.0, 0.0};
    scene::Avatar avatar;
    avatar.name = "column";
    avatar.shape = folder.path() / "flat.gltf";
    std::ofstream(folder.path() / "flat.gltf") << column.dump();
    std::vector<Collider> colliders;
    colliders.emplace_back(avatar, 0.3);
    const std::vector<Vec3> points{Vec3(0.0, 2.0, 0.0), Vec3(0.0, 1.0 - 1e-7, 0.0)};
    const std::string message = refusal([&] {
        CoreConstraint({"column", 0.0, {}}, points, colliders, "here");
    });
    EXPECT_NE(message.find("here: the vertex at (0, 1"), std::string::npos) << message;
    EXPECT_NE(message.find("bone \"tip\", which is flat at the start"), std::string::npos) << message;
}

TEST_F(SoftCores, StandForTheirAvatarInKeysAboutContact)
{
    const auto complaint = [&](const std::string& keys) {
        return refusal([&] {
            block_scene(R"("frames": 1, "cloths": [{"name": "sheet", "disc": {}, "fabric": "silk"}], )" +
                        keys);
        });
    };
    const std::string pair = R"("contact": {"friction_pairs": [{"friction": 0.5, "between": ["silk", )";
    EXPECT_EQ(complaint(pair + R"("jelly"]}]})"), "");
    EXPECT_NE(complaint(pair + R"("box"]}]})")
                  .find("contact.friction_pairs[0].between: \"box\" is replaced in contact by soft body "
                        "\"jelly\"; name that"),
              std::string::npos);
    const std::string gap = complaint(R"("export": [{"file": "a.abc", "attributes": ["gap"]}])");
    EXPECT_NE(
        gap.find("export[0].attributes: \"gap\" is the distance from avatars, and \"box\" is replaced by "
                 "soft body \"jelly\"; add another, or leave gap out"),
        std::string::npos)
        << gap;
}

} // namespace
} // namespace toile::test
