#include "scenes/body_motion.h"

namespace toile {

namespace {

/// The solid of a shape avatar, its lengths scaled; nothing for files and the mannequin.
std::optional<Shape> solid_of(const scene::Avatar& avatar)
{
    if (std::holds_alternative<scene::Plane>(avatar.shape))
        return PlaneShape{};
    if (const auto* sphere = std::get_if<scene::Sphere>(&avatar.shape))
        return SphereShape{sphere->radius * avatar.scale};
    if (const auto* capsule = std::get_if<scene::Capsule>(&avatar.shape))
        return CapsuleShape{0.5 * capsule->length * avatar.scale, capsule->radius * avatar.scale};
    if (const auto* box = std::get_if<scene::Box>(&avatar.shape))
        return BoxShape{0.5 * avatar.scale * box->size};
    return std::nullopt;
}

} // namespace

BodyMotion::BodyMotion(const scene::Avatar& settings)
    : settings_(settings), shape_(solid_of(settings)), motion_(settings.keyframes, settings.translate)
{
    if (!shape_) {
        figure_ = std::make_shared<Figure>(settings, motion_.at(0.0).affine());
        return;
    }
    require_usable(*shape_, settings.name);
    start_pose_.linear() = rotation_of(settings.rotate_deg);
    start_pose_.translation() = settings.translate;
    pose_ = motion_.at(0.0) * start_pose_;
}

bool BodyMotion::advance_to(double t)
{
    const Eigen::Isometry3d carried = motion_.at(t);
    if (figure_)
        return figure_->advance_to(t, carried.affine());
    const Eigen::Isometry3d next = carried * start_pose_;
    const bool moved = next.matrix() != pose_.matrix();
    pose_ = next;
    return moved;
}

} // namespace toile
