#include <algorithm>
#include <array>

#include "avatars/landmarks/skeleton_landmarks.h"
#include "avatars/retarget/cmu_skeleton.h"
#include "avatars/retarget/joint_map.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

/// Joint that carries the whole body: the first one with skin on the way to both legs, else the last one.
/// Joints above it only place the body.
int pelvis_of(const RiggedModel& body, const BodyJoints& joints)
{
    std::vector<char> has_skin(size_t(body.skeleton.size()), 0);
    for (const Influence& influence : body.mesh.influences)
        has_skin[size_t(body.mesh.bones[size_t(influence.bone)].joint)] = 1;
    const std::vector<int> left = path_from_root(body.skeleton, joints.leg[kLeft].start);
    const std::vector<int> right = path_from_root(body.skeleton, joints.leg[kRight].start);
    int pelvis = left.front();
    for (size_t k = 0; k < std::min(left.size(), right.size()) && left[k] == right[k]; ++k) {
        pelvis = left[k];
        if (has_skin[size_t(pelvis)])
            break;
    }
    return pelvis;
}

/// Joints below `upper` and above `lower`, downwards; none if `lower` is not below `upper`.
std::vector<int> joints_between(const Skeleton& skeleton, int upper, int lower)
{
    std::vector<int> between;
    for (int j = skeleton.joints()[size_t(lower)].parent; j != upper;
         j = skeleton.joints()[size_t(j)].parent) {
        if (j < 0)
            return {};
        between.insert(between.begin(), j);
    }
    return between;
}

/// Spreads the joints of one chain over another: the last drives the last, the first the first.
template <size_t kCount>
void spread(const std::vector<int>& chain, const std::array<int, kCount>& source, JointMap& source_of)
{
    for (size_t k = 0; k < chain.size(); ++k) {
        const size_t steps = chain.size() - 1;
        const size_t from = steps == 0 ? kCount - 1 : (k * (kCount - 1) + steps / 2) / steps;
        source_of[size_t(chain[k])] = source[from];
    }
}

/// First child of a joint, -1 if it has none.
int child_of(const Skeleton& skeleton, int joint)
{
    for (int j = joint + 1; j < skeleton.size(); ++j)
        if (skeleton.joints()[size_t(j)].parent == joint)
            return j;
    return -1;
}

} // namespace

JointMap map_from_cmu(SkinnedAvatar& body, const SkeletalMotion& motion)
{
    const CmuJoints cmu = cmu_joints(motion.skeleton);
    if (!cmu.missing.empty())
        throw InvalidInput(
            motion.source + ": has no joint '" + cmu.missing +
            "' of the CMU skeletons; write \"map\": \"names\", or a JSON file that maps its joints");

    const BodyJoints joints = find_joints(body);
    const Skeleton& skeleton = body.model().skeleton;
    JointMap source_of(size_t(skeleton.size()), -1);
    const auto drive = [&](int joint, int source) {
        if (joint >= 0)
            source_of[size_t(joint)] = source;
    };
    const int pelvis = pelvis_of(body.model(), joints);
    drive(pelvis, cmu.pelvis);
    spread(joints_between(skeleton, pelvis, joints.neck), cmu.spine, source_of);
    std::vector<int> neck = joints_between(skeleton, joints.neck, joints.head);
    neck.insert(neck.begin(), joints.neck);
    spread(neck, cmu.neck, source_of);
    drive(joints.head, cmu.head);
    for (const Side side : {kLeft, kRight}) {
        drive(joints.arm[side].start, cmu.arm[side][0]);
        drive(joints.arm[side].middle, cmu.arm[side][1]);
        drive(joints.arm[side].end, cmu.arm[side][2]);
        drive(joints.leg[side].start, cmu.leg[side][0]);
        drive(joints.leg[side].middle, cmu.leg[side][1]);
        drive(joints.leg[side].end, cmu.leg[side][2]);
        drive(child_of(skeleton, joints.leg[side].end), cmu.leg[side][3]);
    }
    return source_of;
}

} // namespace toile::avatars
