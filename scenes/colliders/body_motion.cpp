#include "scenes/colliders/body_motion.h"

namespace toile::scenes {

namespace {

/// Collision shape of a shape avatar, scaled; none for files and the mannequin.
std::optional<collision::Shape> solid_of(const scene::Avatar& avatar)
{
    if (std::holds_alternative<scene::Plane>(avatar.shape))
        return collision::PlaneShape{};
    if (const auto* sphere = std::get_if<scene::Sphere>(&avatar.shape))
        return collision::SphereShape{sphere->radius * avatar.scale};
    if (const auto* capsule = std::get_if<scene::Capsule>(&avatar.shape))
        return collision::CapsuleShape{0.5 * capsule->length * avatar.scale, capsule->radius * avatar.scale};
    if (const auto* box = std::get_if<scene::Box>(&avatar.shape))
        return collision::BoxShape{0.5 * avatar.scale * box->size};
    return std::nullopt;
}

} // namespace

BodyMotion::BodyMotion(const scene::Avatar& settings)
    : settings_(settings), shape_(solid_of(settings)), motion_(settings.keyframes, settings.translate)
{
    if (!shape_) {
        skinned_ = std::make_shared<SkinnedCollider>(settings, motion_.at(0.0).affine());
        return;
    }
    require_usable(*shape_, settings.name);
    start_pose_.linear() = rotation_of(settings.rotate_deg);
    start_pose_.translation() = settings.translate;
    pose_ = motion_.at(0.0) * start_pose_;
}

bool BodyMotion::advance_to(double t)
{
    const Eigen::Isometry3d root_transform = motion_.at(t);
    if (skinned_)
        return skinned_->advance_to(t, root_transform.affine());
    const Eigen::Isometry3d next = root_transform * start_pose_;
    const bool moved = next.matrix() != pose_.matrix();
    pose_ = next;
    return moved;
}

} // namespace toile::scenes
