#include "avatars/retarget/joint_map.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "tests/avatars/retarget/figures.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

/// Joints as "name parent", in order.
Skeleton skeleton_of(const std::vector<std::pair<std::string, std::string>>& joints)
{
    Skeleton skeleton;
    for (const auto& [name, parent] : joints)
        skeleton.add({name, parent.empty() ? -1 : skeleton.find(parent), {}});
    return skeleton;
}

/// A body of one triangle that hangs on the joint of that name.
SkinnedAvatar body_on(Skeleton skeleton, const std::string& joint)
{
    RiggedModel model;
    model.mesh.rest.positions = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY()};
    model.mesh.rest.triangles = {{0, 1, 2}};
    model.mesh.bones = {{skeleton.find(joint), identity_affine()}};
    model.mesh.first = {0, 1, 2, 3};
    model.mesh.influences = {{0, 1.0}, {0, 1.0}, {0, 1.0}};
    model.skeleton = std::move(skeleton);
    return {"body", std::move(model)};
}

Skeleton mixamo()
{
    std::vector<std::pair<std::string, std::string>> joints{{"Armature", ""},
                                                            {"mixamorig:Hips", "Armature"},
                                                            {"mixamorig:Spine", "mixamorig:Hips"},
                                                            {"mixamorig:Spine1", "mixamorig:Spine"},
                                                            {"mixamorig:Spine2", "mixamorig:Spine1"},
                                                            {"mixamorig:Neck", "mixamorig:Spine2"},
                                                            {"mixamorig:Head", "mixamorig:Neck"}};
    for (const std::string side : {"mixamorig:Left", "mixamorig:Right"}) {
        std::string parent = "mixamorig:Spine2";
        for (const char* part : {"Shoulder", "Arm", "ForeArm", "Hand", "HandIndex1"}) {
            joints.emplace_back(side + part, parent);
            parent = side + part;
        }
        parent = "mixamorig:Hips";
        for (const char* part : {"UpLeg", "Leg", "Foot", "ToeBase"}) {
            joints.emplace_back(side + part, parent);
            parent = side + part;
        }
    }
    return skeleton_of(joints);
}

/// The second naming scheme of the CMU library.
Skeleton cmu_of_joints()
{
    std::vector<std::pair<std::string, std::string>> joints{
        {"Hips", ""},        {"lowerback", "Hips"},   {"Chest", "lowerback"},
        {"Chest2", "Chest"}, {"lowerneck", "Chest2"}, {"Neck", "lowerneck"},
        {"Head", "Neck"}};
    for (const std::string side : {"Left", "Right"}) {
        std::string parent = "Chest2";
        for (const char* part : {"Collar", "Shoulder", "Elbow", "Wrist"}) {
            joints.emplace_back(side + part, parent);
            parent = side + part;
        }
        parent = "Hips";
        for (const char* part : {"Hip", "Knee", "Ankle", "Toe"}) {
            joints.emplace_back(side + part, parent);
            parent = side + part;
        }
    }
    return skeleton_of(joints);
}

/// Name of the source of a joint; empty for none.
std::string source_of(const std::string& joint, const SkinnedAvatar& body, const JointMap& map,
                      const SkeletalMotion& motion)
{
    const int source = map[size_t(body.model().skeleton.find(joint))];
    return source < 0 ? "" : motion.skeleton.joints()[size_t(source)].name;
}

std::filesystem::path map_file(const std::string& content)
{
    const std::filesystem::path file = process_folder() / "toile_joint_map.json";
    std::ofstream(file) << content;
    return file;
}

} // namespace

TEST(JointMap, DrivesMixamoFromBothCmuSkeletons)
{
    SkinnedAvatar body = body_on(mixamo(), "mixamorig:Hips");
    const SkeletalMotion first{"first.fbx", test::skeleton_of(Figure{}), {}};
    const SkeletalMotion second{"second.bvh", cmu_of_joints(), {}};
    const JointMap by_first = map_from_cmu(body, first), by_second = map_from_cmu(body, second);
    const std::vector<std::array<std::string, 3>> expected{
        {"Armature", "", ""},
        {"mixamorig:Hips", "Hips", "Hips"},
        {"mixamorig:Spine", "LowerBack", "lowerback"},
        {"mixamorig:Spine1", "Spine", "Chest"},
        {"mixamorig:Spine2", "Spine1", "Chest2"},
        {"mixamorig:Neck", "Neck1", "Neck"},
        {"mixamorig:Head", "Head", "Head"},
        {"mixamorig:LeftShoulder", "", ""},
        {"mixamorig:LeftArm", "LeftArm", "LeftShoulder"},
        {"mixamorig:LeftForeArm", "LeftForeArm", "LeftElbow"},
        {"mixamorig:RightHand", "RightHand", "RightWrist"},
        {"mixamorig:RightHandIndex1", "", ""},
        {"mixamorig:RightUpLeg", "RightUpLeg", "RightHip"},
        {"mixamorig:RightLeg", "RightLeg", "RightKnee"},
        {"mixamorig:LeftFoot", "LeftFoot", "LeftAnkle"},
        {"mixamorig:LeftToeBase", "LeftToeBase", "LeftToe"}};
    for (const auto& [joint, of_first, of_second] : expected) {
        EXPECT_EQ(source_of(joint, body, by_first, first), of_first) << joint;
        EXPECT_EQ(source_of(joint, body, by_second, second), of_second) << joint;
    }
}

TEST(JointMap, NamesTheJointThatACmuSkeletonLacks)
{
    SkinnedAvatar body = body_on(mixamo(), "mixamorig:Hips");
    const SkeletalMotion motion{"walk.fbx", mixamo(), {}};
    EXPECT_EQ(
        refusal([&] { map_from_cmu(body, motion); }),
        "walk.fbx: has no joint 'Hips' of the CMU skeletons; write \"map\": \"names\", or a JSON file that "
        "maps its joints");
}

TEST(JointMap, ReadsPairsOfJoints)
{
    const SkinnedAvatar body = body_on(mixamo(), "mixamorig:Hips");
    const SkeletalMotion motion{"walk.bvh", cmu_of_joints(), {}};
    const JointMap map = read_joint_map(map_file(R"({"mixamorig:LeftLeg": "LeftKnee"})"), body, motion);
    EXPECT_EQ(source_of("mixamorig:LeftLeg", body, map, motion), "LeftKnee");
    EXPECT_EQ(std::count(map.begin(), map.end(), -1), body.model().skeleton.size() - 1);
}

TEST(JointMap, RefusesBadMapsInOneLine)
{
    const SkinnedAvatar body = body_on(mixamo(), "mixamorig:Hips");
    const SkeletalMotion motion{"walk.bvh", cmu_of_joints(), {}};
    const auto said = [&](const std::string& content) {
        return refusal([&] { read_joint_map(map_file(content), body, motion); });
    };
    EXPECT_NE(said("[]").find("toile_joint_map.json: is no map of joints; write {"), std::string::npos);
    EXPECT_NE(said("{}").find("is no map of joints"), std::string::npos);
    EXPECT_NE(said(R"({"mixamorig:LeftLegs": "LeftKnee"})")
                  .find("body has no joint 'mixamorig:LeftLegs'; did you mean 'mixamorig:LeftLeg'?"),
              std::string::npos);
    EXPECT_NE(said(R"({"mixamorig:LeftLeg": "LeftKnees"})")
                  .find("\"mixamorig:LeftLeg\": walk.bvh has no joint 'LeftKnees'; did you mean 'LeftKnee'?"),
              std::string::npos);
    EXPECT_NE(said(R"({"mixamorig:LeftLeg": 3})").find("3 is no name"), std::string::npos);
    EXPECT_NE(refusal([&] { read_joint_map("nowhere.json", body, motion); }).find("can't be read"),
              std::string::npos);
}

} // namespace toile::test
