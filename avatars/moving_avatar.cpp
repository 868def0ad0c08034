#include "avatars/moving_avatar.h"

#include <cmath>
#include <numbers>

#include "core/backend/error.h"

namespace toile {

Affine Placement::world_from_avatar() const
{
    const Vec3 angle = rotate_deg * (std::numbers::pi / 180.0);
    const Mat3 R = (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) *
                    Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) * Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
                       .toRotationMatrix();
    Affine place;
    place.leftCols<3>() = scale * R;
    place.col(3) = translate;
    return place;
}

MovingAvatar::MovingAvatar(std::unique_ptr<Avatar> avatar, Motion motion, const Placement& placement)
    : avatar_(std::move(avatar)), motion_(std::move(motion)),
      world_from_avatar_(placement.world_from_avatar())
{
    if (!(placement.scale > 0.0) || !world_from_avatar_.allFinite())
        throw InvalidInput(avatar_->source() + ": placement scale = " + std::to_string(placement.scale) +
                           " must be positive and all placement numbers finite");
    require_usable(motion_, *avatar_);
    if (!motion_.clip.empty())
        clip_ = avatar_->clip_index(motion_.clip);

    mesh_.triangles = avatar_->triangles();
    mesh_.x_t1.resize(avatar_->vertex_count());
    shown_ = at(0.0);
    avatar_->pose(shown_, world_from_avatar_, mesh_.x_t1);
    mesh_.x_t0 = mesh_.x_t1;
}

PoseAt MovingAvatar::at(double t) const
{
    return pose_at(motion_, clip_, clip_ < 0 ? 0.0 : avatar_->clips()[clip_].duration, t);
}

void MovingAvatar::advance_to(double t_t1)
{
    if (moved_)
        mesh_.x_t0 = mesh_.x_t1;
    const PoseAt next = at(t_t1);
    moved_ = !(next == shown_);
    if (!moved_)
        return;
    avatar_->pose(next, world_from_avatar_, mesh_.x_t1);
    shown_ = next;
}

} // namespace toile
