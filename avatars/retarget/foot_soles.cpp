#include "avatars/retarget/foot_soles.h"

#include <algorithm>
#include <limits>

namespace toile::avatars {

std::vector<Affine> frames_in_world(const RiggedModel& body, View<const JointTransform> local)
{
    std::vector<Affine> frames(size_t(body.skeleton.size()));
    joint_frames(body.skeleton, local, frames);
    for (Affine& frame : frames)
        frame = compose(body.metres_from_file, frame);
    return frames;
}

FootSoles::FootSoles(const RiggedModel& body, const BodyJoints& limbs)
{
    std::vector<char> is_foot(size_t(body.skeleton.size()), 0);
    for (const BodyJoints::Limb& leg : limbs.leg)
        if (leg.end >= 0) {
            const std::vector<char> below = subtree(body.skeleton, leg.end);
            std::transform(below.begin(), below.end(), is_foot.begin(), is_foot.begin(),
                           [](char a, char b) { return char(a | b); });
        }
    add_skin(body, is_foot);

    const std::vector<JointTransform> rest = body.skeleton.rest_pose();
    const std::vector<Affine> bind = frames_in_world(body, rest);
    if (!points_.empty()) {
        const double floor = height(bind);
        for (Point& point : points_)
            point.floor = floor;
        return;
    }
    for (int j = 0; j < body.skeleton.size(); ++j)
        if (is_foot[size_t(j)])
            points_.push_back({j, Vec3::Zero(), bind[size_t(j)](1, 3)});
}

void FootSoles::add_skin(const RiggedModel& body, const std::vector<char>& is_foot)
{
    const SkinnedMesh& mesh = body.mesh;
    for (int v = 0; v < mesh.rest.vertex_count(); ++v) {
        const Bone& bone = mesh.bones[size_t(mesh.influences[size_t(mesh.first[size_t(v)])].bone)];
        if (is_foot[size_t(bone.joint)])
            points_.push_back({bone.joint, apply(bone.joint_from_mesh, mesh.rest.positions[size_t(v)])});
    }
}

double FootSoles::height(const std::vector<Affine>& frames) const
{
    double lowest = std::numeric_limits<double>::infinity();
    for (const Point& point : points_)
        lowest = std::min(lowest, apply(frames[size_t(point.joint)], point.in_joint).y() - point.floor);
    return lowest;
}

} // namespace toile::avatars
