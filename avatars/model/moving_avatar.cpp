#include "avatars/model/moving_avatar.h"

#include <cmath>
#include <numbers>

#include "core/base/error.h"

namespace toile::avatars {

Affine Placement::world_from_avatar() const
{
    const Vec3 angle = rotate_deg * (std::numbers::pi / 180.0);
    const Mat3 R = (Eigen::AngleAxisd(angle.z(), Vec3::UnitZ()) *
                    Eigen::AngleAxisd(angle.y(), Vec3::UnitY()) * Eigen::AngleAxisd(angle.x(), Vec3::UnitX()))
                       .toRotationMatrix();
    Affine transform;
    transform.leftCols<3>() = scale * R;
    transform.col(3) = translate;
    return transform;
}

MovingAvatar::MovingAvatar(std::unique_ptr<Avatar> avatar, Motion motion, const Placement& placement,
                           const Affine& root_transform)
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
    show(at(0.0), root_transform);
    bones_t0_ = bones_t1_;
}

PoseAt MovingAvatar::at(double t) const
{
    return pose_at(motion_, clip_, clip_ < 0 ? 0.0 : avatar_->clips()[clip_].duration, t);
}

void MovingAvatar::show(const PoseAt& at, const Affine& root_transform)
{
    avatar_->pose_bones(at, compose(root_transform, world_from_avatar_), bones_t1_);
    shown_ = at;
    shown_root_transform_ = root_transform;
}

void MovingAvatar::advance_to(double t_t1, const Affine& root_transform)
{
    if (moved_)
        bones_t0_ = bones_t1_;
    const PoseAt next = at(t_t1);
    moved_ = !(next == shown_ && root_transform == shown_root_transform_);
    if (moved_)
        show(next, root_transform);
}

} // namespace toile::avatars
