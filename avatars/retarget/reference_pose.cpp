#include "avatars/retarget/reference_pose.h"

#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

using Eigen::Quaterniond;

/// Two joints at the ends of a bone of a limb.
struct LimbBone {
    int start = -1;
    int end = -1;
};

/// Position of the joints of both skeletons by the joints of the body.
class PosePair {
public:
    PosePair(const WorldPose& body, const WorldPose& motion, const JointMap& source_of)
        : body_(body), motion_(motion), source_of_(source_of)
    {
    }

    bool has(int joint) const { return joint >= 0 && source_of_[size_t(joint)] >= 0; }
    bool has(const LimbBone& bone) const { return has(bone.start) && has(bone.end); }
    Vec3 in_body(int joint) const { return body_.position[size_t(joint)]; }
    Vec3 in_motion(int joint) const { return motion_.position[size_t(source_of_[size_t(joint)])]; }
    Vec3 in_body(const LimbBone& bone) const { return in_body(bone.end) - in_body(bone.start); }
    Vec3 in_motion(const LimbBone& bone) const { return in_motion(bone.end) - in_motion(bone.start); }

private:
    const WorldPose& body_;
    const WorldPose& motion_;
    const JointMap& source_of_;
};

/// Columns left, up, front as the nearest axes; nothing where left and up can't be told apart.
std::optional<Mat3> body_axes(const Vec3& left, const Vec3& up)
{
    const Vec3 x = nearest_axis(left), y = nearest_axis(up);
    if (std::abs(x.dot(y)) > 0.5)
        return std::nullopt;
    Mat3 axes;
    axes << x, y, x.cross(y);
    return axes;
}

/// Axes of the body and of the motion, by hips and shoulders.
std::optional<std::pair<Mat3, Mat3>> axes_of(const PosePair& poses, const BodyJoints& limbs)
{
    const int hip_left = limbs.leg[kLeft].start, hip_right = limbs.leg[kRight].start;
    const int arm_left = limbs.arm[kLeft].start, arm_right = limbs.arm[kRight].start;
    for (const int joint : {hip_left, hip_right, arm_left, arm_right})
        if (!poses.has(joint))
            return std::nullopt;
    const auto axes_by = [&](const auto& at) {
        const Vec3 left = at(hip_left) - at(hip_right) + at(arm_left) - at(arm_right);
        return body_axes(left, at(arm_left) + at(arm_right) - at(hip_left) - at(hip_right));
    };
    const std::optional<Mat3> body = axes_by([&](int joint) { return poses.in_body(joint); });
    const std::optional<Mat3> motion = axes_by([&](int joint) { return poses.in_motion(joint); });
    if (!body || !motion)
        return std::nullopt;
    return std::pair(*body, *motion);
}

double leg_length(const BodyJoints& limbs, const PosePair& poses, bool of_body)
{
    double length = 0.0;
    for (const BodyJoints::Limb& leg : limbs.leg)
        for (const LimbBone& bone : {LimbBone{leg.start, leg.middle}, LimbBone{leg.middle, leg.end}})
            length += (of_body ? poses.in_body(bone) : poses.in_motion(bone)).norm();
    return length;
}

/// Total length from mapped joints to their nearest mapped ancestors.
double mapped_length(const Skeleton& skeleton, const PosePair& poses, bool of_body)
{
    double length = 0.0;
    for (int j = 0; j < skeleton.size(); ++j) {
        int above = skeleton.joints()[size_t(j)].parent;
        while (above >= 0 && !poses.has(above))
            above = skeleton.joints()[size_t(above)].parent;
        if (poses.has(j) && above >= 0)
            length += (of_body ? poses.in_body({above, j}) : poses.in_motion({above, j})).norm();
    }
    return length;
}

double metres_per_unit(const Skeleton& skeleton, const BodyJoints& limbs, const PosePair& poses,
                       const std::string& source)
{
    bool has_legs = true;
    for (const BodyJoints::Limb& leg : limbs.leg)
        for (const int joint : {leg.start, leg.middle, leg.end})
            has_legs = has_legs && poses.has(joint);
    const auto length = [&](bool of_body) {
        return has_legs ? leg_length(limbs, poses, of_body) : mapped_length(skeleton, poses, of_body);
    };
    const double ratio = length(true) / length(false);
    if (!std::isfinite(ratio) || !(ratio > 0.0))
        throw InvalidInput(source +
                           ": its mapped bones have no length, or those of the body; map joints that lie "
                           "apart, as hip, knee and ankle");
    return ratio;
}

} // namespace

ReferencePose reference_pose(const Skeleton& skeleton, const WorldPose& body, const BodyJoints& limbs,
                             const WorldPose& motion, const JointMap& source_of, const std::string& source)
{
    const PosePair poses(body, motion, source_of);
    ReferencePose result;
    result.metres_per_unit = metres_per_unit(skeleton, limbs, poses, source);
    if (const auto axes = axes_of(poses, limbs)) {
        result.body_from_motion = Quaterniond(Mat3(axes->first * axes->second.transpose()));
        result.front = axes->first.col(2);
    }

    // Turn the bones of limbs into the directions of the reference pose; hands follow, feet do not.
    std::vector<std::optional<Quaterniond>> own(size_t(skeleton.size()));
    const auto align = [&](const LimbBone& bone) {
        if (poses.has(bone) && poses.in_body(bone).norm() > 0.0 && poses.in_motion(bone).norm() > 0.0)
            own[size_t(bone.start)] = Quaterniond::FromTwoVectors(
                poses.in_body(bone), result.body_from_motion * poses.in_motion(bone));
    };
    for (const Side side : {kLeft, kRight}) {
        for (const BodyJoints::Limb& limb : {limbs.arm[side], limbs.leg[side]}) {
            align({limb.start, limb.middle});
            align({limb.middle, limb.end});
        }
        if (const int ankle = limbs.leg[side].end; ankle >= 0)
            own[size_t(ankle)] = Quaterniond::Identity();
    }
    for (int j = 0; j < skeleton.size(); ++j) {
        const int parent = skeleton.joints()[size_t(j)].parent;
        result.reference_from_bind.push_back(own[size_t(j)] ? *own[size_t(j)]
                                             : parent < 0   ? Quaterniond::Identity()
                                                            : result.reference_from_bind[size_t(parent)]);
    }
    return result;
}

} // namespace toile::avatars
