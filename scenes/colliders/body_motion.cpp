#include "scenes/colliders/body_motion.h"

#include <cmath>
#include <limits>

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

/// Half the thickness of a forearm [m], and the part of a shape's half thickness in which cloth is still
/// pushed out on its own side [-].
constexpr double kHalfLimb = 0.04, kReach = 0.75;

/// Radii of the balls around a shape's origin that it contains, and that contain it [m].
struct Radii {
    double inner, outer;
};

Radii radii_of(const collision::Shape& shape)
{
    if (const auto* sphere = std::get_if<collision::SphereShape>(&shape))
        return {sphere->radius, sphere->radius};
    if (const auto* capsule = std::get_if<collision::CapsuleShape>(&shape))
        return {capsule->radius, capsule->half_length + capsule->radius};
    if (const auto* box = std::get_if<collision::BoxShape>(&shape))
        return {box->half_extent.minCoeff(), box->half_extent.norm()};
    return {std::numeric_limits<double>::infinity(), 0.0}; // a plane fills half of space
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

double BodyMotion::motion_to(double t)
{
    if (is_static())
        return 0.0;
    const Eigen::Isometry3d root_transform = motion_.at(t);
    if (skinned_)
        return skinned_->max_motion_to(t, root_transform.affine()) / kHalfLimb;
    const Eigen::Isometry3d next = root_transform * start_pose_;
    const Eigen::AngleAxisd turn(next.linear() * pose_.linear().transpose());
    const Radii radii = radii_of(*shape_);
    const double arc = 2.0 * std::sin(0.5 * std::fabs(turn.angle())) * radii.outer;
    return ((next.translation() - pose_.translation()).norm() + arc) / (kReach * radii.inner);
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
