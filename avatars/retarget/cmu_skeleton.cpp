#include "avatars/retarget/cmu_skeleton.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace toile::avatars {

namespace {

/// Names of the joints of a CMU skeleton. Those of limbs follow "Left" or "Right".
struct CmuNames {
    const char* pelvis;
    std::array<const char*, 3> spine; ///< upwards
    std::array<const char*, 2> neck;
    const char* head;
    std::array<const char*, 3> arm; ///< of shoulder, elbow and wrist
    std::array<const char*, 4> leg; ///< of hip, knee, ankle and the ball of the foot
};

// clang-format off
constexpr std::array<CmuNames, 2> kCmuNames{{
    {"Hips", {"LowerBack", "Spine", "Spine1"}, {"Neck", "Neck1"}, "Head",
     {"Arm", "ForeArm", "Hand"}, {"UpLeg", "Leg", "Foot", "ToeBase"}},
    {"Hips", {"lowerback", "Chest", "Chest2"}, {"lowerneck", "Neck"}, "Head",
     {"Shoulder", "Elbow", "Wrist"}, {"Hip", "Knee", "Ankle", "Toe"}},
}};
// clang-format on
constexpr std::array<const char*, 2> kSideNames{"Left", "Right"}; // by Side

bool equal_without_case(const std::string& a, const std::string& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// Joints by one naming scheme, and how many of them are missing.
std::pair<CmuJoints, int> find_joints_named(const CmuNames& names, const Skeleton& skeleton)
{
    std::pair<CmuJoints, int> result;
    CmuJoints& found = result.first;
    int& missing = result.second;
    const auto find = [&](const std::string& name) {
        for (int j = 0; j < skeleton.size(); ++j)
            if (equal_without_case(skeleton.joints()[size_t(j)].name, name))
                return j;
        if (missing++ == 0)
            found.missing = name;
        return -1;
    };
    const auto find_all = [&](const auto& parts, const std::string& side, auto& joints) {
        std::transform(parts.begin(), parts.end(), joints.begin(),
                       [&](const char* part) { return find(side + part); });
    };
    found.pelvis = find(names.pelvis);
    find_all(names.spine, "", found.spine);
    find_all(names.neck, "", found.neck);
    found.head = find(names.head);
    for (const Side side : {kLeft, kRight}) {
        find_all(names.arm, kSideNames[side], found.arm[side]);
        find_all(names.leg, kSideNames[side], found.leg[side]);
    }
    return result;
}

} // namespace

CmuJoints cmu_joints(const Skeleton& skeleton)
{
    const auto [first, first_missing] = find_joints_named(kCmuNames[0], skeleton);
    const auto [second, second_missing] = find_joints_named(kCmuNames[1], skeleton);
    return second_missing < first_missing ? second : first;
}

WorldPose standing_pose(const Skeleton& skeleton, const CmuJoints& joints)
{
    WorldPose pose = rest_world_pose(skeleton, identity_affine());
    const auto at = [&](int joint) { return pose.position[size_t(joint)]; };
    const Vec3 up = nearest_axis(at(joints.head) - at(joints.pelvis));
    for (const std::array<int, 4>& leg : joints.leg) {
        const Vec3 hip = at(leg[0]);
        const auto upright = Eigen::Quaterniond::FromTwoVectors(at(leg[2]) - hip, -up);
        const std::vector<char> is_in_leg = subtree(skeleton, leg[0]);
        for (size_t j = 0; j < is_in_leg.size(); ++j)
            if (is_in_leg[j]) {
                pose.rotation[j] = upright * pose.rotation[j];
                pose.position[j] = hip + upright * (pose.position[j] - hip);
            }
    }
    return pose;
}

} // namespace toile::avatars
