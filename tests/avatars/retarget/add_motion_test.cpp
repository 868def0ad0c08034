#include "avatars/retarget/add_motion.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "avatars/load_avatar.h"
#include "avatars/retarget/copy_clip.h"
#include "core/base/error.h"
#include "tests/avatars/column.h"
#include "tests/avatars/retarget/figures.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

std::filesystem::path temporary_file(const std::string& name, const std::string& content)
{
    const std::filesystem::path file = process_folder() / ("toile_motion_" + name);
    std::ofstream(file) << content;
    return file;
}

/// A BVH in units of a centimetre: the joint `tip` on `base` bends by 90 degrees about Z in a second.
std::filesystem::path bending_bvh(const std::string& base = "base", const std::string& tip = "tip")
{
    return temporary_file("bend.bvh", "HIERARCHY\nROOT " + base +
                                          "\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition "
                                          "Zrotation Yrotation Xrotation\nJOINT " +
                                          tip +
                                          "\n{\nOFFSET 0 50 0\nCHANNELS 3 Zrotation Yrotation Xrotation\n"
                                          "End Site\n{\nOFFSET 0 50 0\n}\n}\n}\nMOTION\nFrames: 3\n"
                                          "Frame Time: 0.5\n0 0 0 0 0 0 0 0 0\n0 0 0 0 0 0 45 0 0\n"
                                          "0 0 0 0 0 0 90 0 0\n");
}

std::unique_ptr<Avatar> column()
{
    AvatarSettings settings;
    settings.file = column_file();
    return load_avatar(settings);
}

std::string refusal(const MotionSource& source, Avatar& body)
{
    try {
        add_motion(body, source);
        return "";
    } catch (const InvalidInput& error) {
        return error.what();
    }
}

std::string refusal(const MotionSource& source) { return refusal(source, *column()); }

void expect_line(const std::string& message, const std::vector<std::string>& parts)
{
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    for (const std::string& part : parts)
        EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
}

void expect_same_motion(Avatar& body, const std::string& a, const std::string& b,
                        const std::vector<double>& times, double tolerance)
{
    for (const double time : times) {
        const std::vector<Vec3> x = posed(body, {body.clip_index(a), time});
        const std::vector<Vec3> y = posed(body, {body.clip_index(b), time});
        for (size_t v = 0; v < x.size(); ++v)
            EXPECT_LT((x[v] - y[v]).norm(), tolerance) << v << " at " << time;
    }
}

} // namespace

TEST(AddMotion, PlaysABvhByTheNamesOfItsBones)
{
    const auto body = column();
    const std::string name = add_motion(*body, {bending_bvh()});
    EXPECT_EQ(body->clips().size(), 3u);
    EXPECT_DOUBLE_EQ(body->clips().back().duration, 1.0);
    expect_same_motion(*body, name, "bend", {0.0, 0.3, 0.5, 1.0}, 1e-6); // assimp's numbers are single
}

TEST(AddMotion, PlaysABvhByAMapOfItsBones)
{
    const std::filesystem::path map = temporary_file("map.json", R"({"base": "lower", "tip": "upper"})");
    const auto body = column();
    const std::string name = add_motion(*body, {bending_bvh("lower", "upper"), "", map.string()});
    expect_same_motion(*body, name, "bend", {0.0, 0.3, 0.5, 1.0}, 1e-6);
}

TEST(AddMotion, GivesClipsOfOneNameNumbers)
{
    const auto body = column();
    EXPECT_EQ(add_motion(*body, {column_file(), "bend"}), "bend#2");
    EXPECT_EQ(add_motion(*body, {column_file(), "bend"}), "bend#3");
    EXPECT_EQ(add_motion(*body, {column_file()}), "slide#2"); // the longest
    expect_same_motion(*body, "slide#2", "slide", {0.0, 0.7, 2.0}, 1e-12);
}

TEST(AddMotion, LoopsItsRootWhereTheClipEnds)
{
    const auto body = column();
    const std::string name = add_motion(*body, {column_file(), "slide"});
    const std::vector<Vec3> x = posed(*body, {body->clip_index(name), 0.0, 0.0, 2});
    const std::vector<Vec3> rest = posed(*body, {});
    EXPECT_LT((x[0] - rest[0] - Vec3(0.0, 0.0, 2.0)).norm(), 1e-12);
}

/// Blender writes an armature in centimetres, turned from Z up, above the bones.
TEST(CopyClip, KeepsTheMotionInTheWorldUnderAnArmature)
{
    const auto body = column();
    const auto& skinned = dynamic_cast<const SkinnedAvatar&>(*body);
    const Eigen::Quaterniond z_up = rotation(-90.0, Vec3::UnitX());
    SkeletalMotion motion{"armature.fbx", {}, {}};
    motion.skeleton.add({"Armature", -1, {Vec3::Zero(), z_up, Vec3::Constant(100.0)}});
    motion.skeleton.add({"base", 0, {Vec3::Zero(), z_up.conjugate(), Vec3::Ones()}});
    motion.skeleton.add({"tip", 1, {Vec3(0.0, 0.5, 0.0), Eigen::Quaterniond::Identity(), Vec3::Ones()}});
    for (Clip clip : skinned.model().clips) {
        for (JointTrack& track : clip.tracks) {
            const bool is_base = skinned.model().skeleton.joints()[size_t(track.joint)].name == "base";
            track.joint = is_base ? 1 : 2;
            for (Key<Vec3>& key : track.translation.keys)
                key.value = is_base ? z_up.conjugate() * key.value : key.value;
        }
        motion.clips.push_back(std::move(clip));
    }
    auto& writable = dynamic_cast<SkinnedAvatar&>(*body);
    for (const Clip& clip : motion.clips)
        expect_same_motion(*body, writable.add_clip(copy_clip(skinned, motion, clip)), clip.name,
                           {0.0, 0.4, 1.0}, 1e-9);
}

TEST(AddMotion, RefusesInOneLineWithTheNearestChoice)
{
    expect_line(refusal({"nowhere.bvh"}), {"nowhere.bvh: no such file"});
    expect_line(refusal({column_file(), "bent"}), {"no clip 'bent'; did you mean 'bend'?", "'slide'"});
    expect_line(refusal({bending_bvh("basis", "top")}),
                {"toile_motion_bend.bvh: clip 'Motion' moves 2 joints, of which ",
                 "bending_column.gltf has 0",
                 "no 'basis', the nearest is 'base'; write \"map\" with a JSON file"});
    expect_line(refusal({bending_bvh(), "", "cmu"}), {"has no joint 'Hips' of the CMU skeletons"});
    expect_line(refusal({bending_bvh(), "", "nowhere.json"}), {"nowhere.json: can't be read"});
}

TEST(AddMotion, RefusesAFileWithoutMotion)
{
    std::stringstream content;
    content << std::ifstream(column_file()).rdbuf();
    std::string text = content.str();
    text.replace(text.find("\"animations\""), 12, "\"extras\"");
    expect_line(refusal({temporary_file("still.gltf", text)}),
                {"toile_motion_still.gltf: has no clip; name a file with an animation of bones"});
}

TEST(AddMotion, RefusesNumbersThatAreNotFinite)
{
    std::stringstream content;
    content << std::ifstream(bending_bvh()).rdbuf();
    const std::string text = content.str();
    const std::string header = text.substr(0, text.find("Frames:"));
    expect_line(refusal({temporary_file("nan.bvh", header + "Frames: 2\nFrame Time: 0.5\n0 0 0 0 0 0 0 0 0\n"
                                                            "0 nan 0 0 0 0 0 0 0\n")}),
                {"toile_motion_nan.bvh: clip 'Motion': joint 'base': translation: key 1 at 0.5"});
}

TEST(AddMotion, RefusesABodyWithoutBones)
{
    AvatarSettings settings;
    settings.file =
        temporary_file("body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n"
                                   "f 1 4 3\n");
    const auto body = load_avatar(settings);
    expect_line(refusal({bending_bvh()}, *body),
                {"toile_motion_body.obj: has no bones", "use a .glb, .gltf or .fbx body"});
}

/// Rotations can't be copied between bones whose axes differ.
TEST(CopyClip, RefusesBonesOfOtherAxes)
{
    const auto body = column();
    SkeletalMotion motion{"other.fbx", {}, {}};
    motion.skeleton.add({"base", -1, {}});
    motion.skeleton.add({"tip", 0, {Vec3(0.5, 0.0, 0.0)}});
    const Clip clip{"bend", 1.0, {{0}, {1}}};
    try {
        copy_clip(dynamic_cast<const SkinnedAvatar&>(*body), motion, clip);
        FAIL() << "accepted";
    } catch (const InvalidInput& error) {
        expect_line(error.what(), {"other.fbx: its bones have other axes", "'tip' in 'base'"});
    }
}

} // namespace toile::test
