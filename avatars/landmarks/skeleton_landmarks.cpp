#include "avatars/landmarks/skeleton_landmarks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "avatars/landmarks/cross_section.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

std::vector<Vec3> joint_positions(const RiggedModel& model, const std::vector<Affine>& bones)
{
    std::vector<std::optional<Vec3>> found(size_t(model.skeleton.size()));
    for (size_t b = 0; b < model.mesh.bones.size(); ++b) {
        const Bone& bone = model.mesh.bones[b];
        found[size_t(bone.joint)] = apply(compose(bones[b], inverse(bone.joint_from_mesh)), Vec3::Zero());
    }
    std::vector<Vec3> position(found.size(), Vec3::Zero());
    for (size_t j = 0; j < found.size(); ++j) {
        const int parent = model.skeleton.joints()[j].parent;
        position[j] = found[j] ? *found[j] : parent >= 0 ? position[size_t(parent)] : Vec3(Vec3::Zero());
    }
    return position;
}

std::vector<BodyPart> parts_of(const RiggedModel& model, const BodyJoints& joints)
{
    std::vector<BodyPart> of_joint(size_t(model.skeleton.size()), BodyPart::Torso);
    const auto mark = [&](int root, BodyPart part) {
        const std::vector<char> below = subtree(model.skeleton, root);
        for (size_t j = 0; j < below.size(); ++j)
            if (below[j])
                of_joint[j] = part;
    };
    mark(joints.neck, BodyPart::Neck);
    mark(joints.arm[kLeft].start, BodyPart::LeftArm);
    mark(joints.arm[kRight].start, BodyPart::RightArm);
    mark(joints.leg[kLeft].start, BodyPart::LeftLeg);
    mark(joints.leg[kRight].start, BodyPart::RightLeg);

    const SkinView skin = model.mesh.skin();
    std::vector<BodyPart> part;
    for (int v = 0; v < skin.rest.size(); ++v)
        part.push_back(of_joint[size_t(model.mesh.bones[size_t(skin.influences[skin.first[v]].bone)].joint)]);
    return part;
}

/// Vertices of a part within `reach` of a plane, or as much further as gives enough of them.
std::vector<Vec3> ring(const PosedSkeleton& body, const SectionPlane& plane, double reach, BodyPart part)
{
    constexpr size_t kEnough = 16;
    std::vector<Vec3> found;
    for (int wider = 0; wider < 3 && found.size() < kEnough; ++wider, reach *= 2.0) {
        found.clear();
        for (size_t v = 0; v < body.vertices.size(); ++v)
            if (body.part[v] == part && std::abs(plane.normal.dot(body.vertices[v] - plane.point)) < reach)
                found.push_back(body.vertices[v]);
    }
    return found;
}

Vec3 near_axis(const Vec3& direction)
{
    constexpr double kCosine = 0.966; // [-] of 15 degrees
    for (int k = 0; k < 3; ++k)
        if (std::abs(direction[k]) > kCosine)
            return direction[k] > 0.0 ? Vec3(Vec3::Unit(k)) : Vec3(-Vec3::Unit(k));
    return direction;
}

} // namespace

BodyJoints find_joints(SkinnedAvatar& avatar)
{
    const RiggedModel& model = avatar.model();
    BodyJoints joints = joints_by_name(model.skeleton);
    if (!joints.is_whole()) {
        std::vector<Affine> bones(size_t(avatar.bone_count()));
        avatar.pose_bones({}, identity_affine(), bones);
        const BodyJoints by_tree = joints_by_tree(model.skeleton, joint_positions(model, bones));
        if (!by_tree.is_whole())
            throw InvalidInput(avatar.source() + ": " + joints.missing() + " can't be found among its " +
                               std::to_string(model.skeleton.size()) +
                               " joints; name them as LeftArm, LeftForeArm, LeftHand, LeftUpLeg, LeftLeg, "
                               "LeftFoot, Neck and Head");
        joints = by_tree;
    }
    return joints;
}

PosedSkeleton pose_skeleton(SkinnedAvatar& avatar, const PoseAt& at, const Affine& world_from_avatar)
{
    PosedSkeleton result;
    result.joints = find_joints(avatar);
    std::vector<Affine> bones(size_t(avatar.bone_count()));
    avatar.pose_bones(at, world_from_avatar, bones);
    result.position = joint_positions(avatar.model(), bones);
    result.part = parts_of(avatar.model(), result.joints);
    result.vertices.resize(size_t(avatar.vertex_count()));
    avatar.skin_vertices(bones, result.vertices);
    return result;
}

BodyLandmarks landmarks_of(const PosedSkeleton& body)
{
    const auto at = [&](int joint) { return body.position[size_t(joint)]; };
    const BodyJoints& joints = body.joints;
    BodyLandmarks result;
    result.neck_base = at(joints.neck);
    result.neck_top = 0.5 * (at(joints.neck) + at(joints.head));
    for (const Side side : {kLeft, kRight}) {
        result.arm[side] = {at(joints.arm[side].start), at(joints.arm[side].end)};
        result.leg[side].ankle = at(joints.leg[side].end);
    }

    const Vec3 hip_left = at(joints.leg[kLeft].start), hip_right = at(joints.leg[kRight].start);
    const Vec3 hips = 0.5 * (hip_left + hip_right);
    result.up = near_axis((result.neck_base - hips).normalized());
    Vec3 left = hip_left - hip_right + at(joints.arm[kLeft].start) - at(joints.arm[kRight].start);
    left -= result.up.dot(left) * result.up;
    result.front = near_axis(left.cross(result.up).normalized());
    left = result.left();

    // The crotch: the lowest skin of the trunk between the hips.
    const double trunk = (result.neck_base - hips).norm();
    result.crotch = hips - 0.2 * trunk * result.up;
    double lowest = 0.0;
    for (size_t v = 0; v < body.vertices.size(); ++v) {
        const Vec3 x = body.vertices[v] - hips;
        if (body.part[v] == BodyPart::Torso && std::abs(left.dot(x)) < 0.05 * trunk &&
            result.up.dot(x) < lowest) {
            lowest = result.up.dot(x);
            result.crotch = body.vertices[v] - left.dot(x) * left;
        }
    }
    for (const Side side : {kLeft, kRight}) {
        const Vec3 hip = at(joints.leg[side].start), knee = at(joints.leg[side].middle);
        const Vec3 down = (knee - hip).normalized();
        const double drop = std::clamp((result.crotch - hip).dot(down), 0.0, 0.5 * (knee - hip).norm());
        result.leg[side].top = hip + drop * down;
        const SectionPlane plane = SectionPlane::through(result.leg[side].top, down);
        const std::vector<Vec3> thigh =
            ring(body, plane, 0.03 * trunk, side == kLeft ? BodyPart::LeftLeg : BodyPart::RightLeg);
        if (const std::vector<Vec3> hull = convex_hull(thigh, plane); hull.size() > 2)
            result.leg[side].top = loop_through(hull, plane).center;
    }
    return result;
}

} // namespace toile::avatars
