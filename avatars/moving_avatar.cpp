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

MovingAvatar::MovingAvatar(std::unique_ptr<Avatar> avatar, Motion motion, const Placement& placement,
                           const Affine& carried)
    : avatar_(std::move(avatar)), motion_(std::move(motion)),
      world_from_avatar_(placement.world_from_avatar())
{
    if (!(placement.scale > 0.0) || !world_from_avatar_.allFinite())
        throw InvalidInput(avatar_->source() + ": placement scale = " + std::to_string(placement.scale) +
                           " must be positive and all placement numbers finite");
    require_usable(motion_, *avatar_);
    if (!motion_.clip.empty())
        clip_ = avatar_->clip_index(motion_.clip);

    bones_t1_.resize(size_t(avatar_->bone_count()));
    show(at(0.0), carried);
    bones_t0_ = bones_t1_;
}

PoseAt MovingAvatar::at(double t) const
{
    return pose_at(motion_, clip_, clip_ < 0 ? 0.0 : avatar_->clips()[clip_].duration, t);
}

void MovingAvatar::show(const PoseAt& at, const Affine& carried)
{
    avatar_->pose_bones(at, compose(carried, world_from_avatar_), bones_t1_);
    shown_ = at;
    shown_carried_ = carried;
}

void MovingAvatar::advance_to(double t_t1, const Affine& carried)
{
    if (moved_)
        bones_t0_ = bones_t1_;
    const PoseAt next = at(t_t1);
    moved_ = !(next == shown_ && carried == shown_carried_);
    if (moved_)
        show(next, carried);
}

} // namespace toile
