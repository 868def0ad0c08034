#include <gtest/gtest.h>

#include "avatars/landmarks/body_joints.h"

namespace toile::test {

using namespace avatars;

namespace {

/// A standing person's joints: name, parent, position [m].
struct Row {
    std::string name;
    int parent;
    Vec3 at;
};

Skeleton skeleton_of(const std::vector<Row>& rows)
{
    Skeleton skeleton;
    for (const Row& row : rows)
        skeleton.add({row.name, row.parent, {}});
    return skeleton;
}

/// Names of joints 0 to 15 in one program's convention: hips, neck, head, then left and right upper arm,
/// forearm, hand, thigh, shin, foot, and a spine that must not be taken for any.
struct Convention {
    const char* program;
    std::vector<std::string> names;
};

const std::vector<Convention>& conventions()
{
    static const std::vector<Convention> kConventions{
        {"CMU",
         {"Hips", "Neck", "Head", "LeftArm", "LeftForeArm", "LeftHand", "LeftUpLeg", "LeftLeg", "LeftFoot",
          "RightArm", "RightForeArm", "RightHand", "RightUpLeg", "RightLeg", "RightFoot", "LHipJoint"}},
        {"Mixamo",
         {"mixamorig:Hips", "mixamorig:Neck", "mixamorig:Head", "mixamorig:LeftArm", "mixamorig:LeftForeArm",
          "mixamorig:LeftHand", "mixamorig:LeftUpLeg", "mixamorig:LeftLeg", "mixamorig:LeftFoot",
          "mixamorig:RightArm", "mixamorig:RightForeArm", "mixamorig:RightHand", "mixamorig:RightUpLeg",
          "mixamorig:RightLeg", "mixamorig:RightFoot", "mixamorig:LeftShoulder"}},
        {"BVH with elbows",
         {"Hips", "Neck", "Head", "LeftShoulder", "LeftElbow", "LeftWrist", "LeftHip", "LeftKnee",
          "LeftAnkle", "RightShoulder", "RightElbow", "RightWrist", "RightHip", "RightKnee", "RightAnkle",
          "LeftCollar"}},
        {"SMPL",
         {"Pelvis", "Neck", "Head", "L_Shoulder", "L_Elbow", "L_Wrist", "L_Hip", "L_Knee", "L_Ankle",
          "R_Shoulder", "R_Elbow", "R_Wrist", "R_Hip", "R_Knee", "R_Ankle", "L_Foot"}},
        {"Blender",
         {"hips", "neck", "head", "upper_arm.L", "forearm.L", "hand.L", "thigh.L", "shin.L", "foot.L",
          "upper_arm.R", "forearm.R", "hand.R", "thigh.R", "shin.R", "foot.R", "shoulder.L"}},
        {"Unreal",
         {"pelvis", "neck_01", "head", "upperarm_l", "lowerarm_l", "hand_l", "thigh_l", "calf_l", "foot_l",
          "upperarm_r", "lowerarm_r", "hand_r", "thigh_r", "calf_r", "foot_r", "clavicle_l"}},
        {"3ds Max",
         {"Bip01 Pelvis", "Bip01 Neck", "Bip01 Head", "Bip01 L UpperArm", "Bip01 L Forearm", "Bip01 L Hand",
          "Bip01 L Thigh", "Bip01 L Calf", "Bip01 L Foot", "Bip01 R UpperArm", "Bip01 R Forearm",
          "Bip01 R Hand", "Bip01 R Thigh", "Bip01 R Calf", "Bip01 R Foot", "Bip01 L Clavicle"}},
    };
    return kConventions;
}

} // namespace

TEST(BodyJoints, NamesOfSevenProgramsAreKnown)
{
    for (const Convention& convention : conventions()) {
        std::vector<Row> rows;
        for (const std::string& name : convention.names)
            rows.push_back({name, rows.empty() ? -1 : 0, Vec3::Zero()});
        const BodyJoints joints = joints_by_name(skeleton_of(rows));
        EXPECT_TRUE(joints.is_whole()) << convention.program << ": " << joints.missing();
        EXPECT_EQ(joints.neck, 1) << convention.program;
        EXPECT_EQ(joints.head, 2) << convention.program;
        for (const Side side : {kLeft, kRight}) {
            const int first = side == kLeft ? 3 : 9;
            const BodyJoints::Limb &arm = joints.arm[side], &leg = joints.leg[side];
            const std::vector<int> found{arm.start, arm.middle, arm.end, leg.start, leg.middle, leg.end};
            for (int k = 0; k < 6; ++k)
                EXPECT_EQ(found[size_t(k)], first + k)
                    << convention.program << ", " << rows[size_t(first + k)].name;
        }
    }
}

TEST(BodyJoints, NamelessTreeIsReadByItsShapeAndFacing)
{
    // Faces -X: its left is then +Z. One arm has a collarbone and fingers.
    const std::vector<Row> rows{
        {"n0", -1, {0, 1.0, 0}},       {"n1", 0, {0, 1.3, 0}},       {"n2", 1, {0, 1.5, 0}},
        {"n3", 2, {0, 1.6, 0}},        {"n4", 1, {0, 1.45, 0.05}},   {"n5", 4, {0, 1.45, 0.2}},
        {"n6", 5, {0, 1.2, 0.35}},     {"n7", 6, {0, 1.0, 0.5}},     {"n8", 7, {0, 0.95, 0.55}},
        {"n9", 7, {-0.03, 0.95, 0.5}}, {"n10", 1, {0, 1.45, -0.2}},  {"n11", 10, {0, 1.2, -0.35}},
        {"n12", 11, {0, 1.0, -0.5}},   {"n13", 0, {0, 0.9, 0.1}},    {"n14", 13, {0, 0.5, 0.1}},
        {"n15", 14, {0, 0.1, 0.1}},    {"n16", 15, {-0.15, 0, 0.1}}, {"n17", 0, {0, 0.9, -0.1}},
        {"n18", 17, {0, 0.5, -0.1}},   {"n19", 18, {0, 0.1, -0.1}},  {"n20", 19, {-0.15, 0, -0.1}}};
    std::vector<Vec3> position;
    for (const Row& row : rows)
        position.push_back(row.at);
    const Skeleton skeleton = skeleton_of(rows);
    EXPECT_FALSE(joints_by_name(skeleton).is_whole());
    const BodyJoints joints = joints_by_tree(skeleton, position);
    ASSERT_TRUE(joints.is_whole()) << joints.missing();
    EXPECT_EQ(joints.head, 3);
    EXPECT_EQ(joints.neck, 2);
    EXPECT_EQ(joints.arm[kLeft].start, 5);
    EXPECT_EQ(joints.arm[kLeft].end, 7);
    EXPECT_EQ(joints.arm[kRight].start, 10);
    EXPECT_EQ(joints.leg[kLeft].end, 15);
    EXPECT_EQ(joints.leg[kRight].start, 17);
}

TEST(BodyJoints, MissingLimbsAreNamed)
{
    const BodyJoints joints = joints_by_name(
        skeleton_of({{"LeftArm", -1, {}}, {"LeftForeArm", 0, {}}, {"LeftHand", 1, {}}, {"Neck", -1, {}}}));
    EXPECT_EQ(joints.missing(), "right arm, left leg, right leg, head");
}

} // namespace toile::test
