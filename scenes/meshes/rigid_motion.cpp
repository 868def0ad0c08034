#include "scenes/meshes/rigid_motion.h"

#include <algorithm>
#include <numbers>
#include <utility>

namespace toile::scenes {

Mat3 rotation_of(const Vec3& rotate_deg)
{
    const Vec3 angle = rotate_deg * (std::numbers::pi / 180.0);
    return (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) *
            Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
        .toRotationMatrix();
}

RigidMotion::RigidMotion(std::vector<scene::Keyframe> keyframes, const Vec3& pivot)
    : keyframes_(std::move(keyframes)), pivot_(pivot)
{
}

Eigen::Isometry3d RigidMotion::at(double t) const
{
    Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
    if (keyframes_.empty())
        return placement;

    const auto after = std::find_if(keyframes_.begin(), keyframes_.end(),
                                    [&](const scene::Keyframe& key) { return key.time > t; });
    scene::Keyframe key = after == keyframes_.begin() ? keyframes_.front() : *(after - 1);
    if (after != keyframes_.begin() && after != keyframes_.end()) {
        const double fraction = (t - key.time) / (after->time - key.time);
        key.translate += fraction * (after->translate - key.translate);
        key.rotate_deg += fraction * (after->rotate_deg - key.rotate_deg);
    }
    placement.linear() = rotation_of(key.rotate_deg);
    placement.translation() = pivot_ + key.translate - placement.linear() * pivot_;
    return placement;
}

} // namespace toile::scenes
