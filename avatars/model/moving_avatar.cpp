#include "avatars/model/moving_avatar.h"

#include <algorithm>
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

namespace {

/// Boxes around the rest positions of the vertices that follow each bone. [bones]
std::vector<Bounds> boxes_of_bones(const SkinView& skin, int bone_count)
{
    std::vector<Bounds> boxes(static_cast<size_t>(bone_count));
    for (int v = 0; v < skin.rest.size(); ++v)
        for (int k = skin.first[v]; k < skin.first[v + 1]; ++k)
            boxes[skin.influences[k].bone].extend(skin.rest[v]);
    return boxes;
}

/// Corners of a box around rest positions: one for that of a bone with one vertex.
unsigned corner_count(const Bounds& box) { return box.lower == box.upper ? 1 : 8; }

Vec3 corner_of(const Bounds& box, unsigned corner)
{
    Vec3 position;
    for (int axis = 0; axis < 3; ++axis)
        position[axis] = ((corner >> axis) & 1) != 0 ? box.upper[axis] : box.lower[axis];
    return position;
}

/// Longest displacement of a vertex by each blend shape of weight 1 [mesh units]. [shapes]
std::vector<double> reaches_of_shapes(const SkinView& skin, int bone_count)
{
    if (skin.offsets.empty())
        return {};
    std::vector<double> reaches(static_cast<size_t>(bone_count - skin.first_shape), 0.0);
    for (const ShapeOffset& part : skin.offsets)
        reaches[part.shape] = std::max(reaches[part.shape], part.offset.norm());
    return reaches;
}

/// Largest distance [m] between the images of a point of the box under two maps: both are affine, so a corner
/// has it.
double max_distance(const Bounds& box, const Affine& a, const Affine& b)
{
    double largest = 0.0;
    for (unsigned corner = 0; corner < corner_count(box); ++corner) {
        const Vec3 p = corner_of(box, corner);
        largest = std::max(largest, (apply(a, p) - apply(b, p)).norm());
    }
    return largest;
}

/// @throws InvalidInput for a bone that moves its box out of range
void require_in_range(View<const Affine> bones, const std::vector<Bounds>& boxes, double time,
                      const std::string& source)
{
    for (int b = 0; b < bones.size(); ++b) {
        if (boxes[size_t(b)].empty())
            continue;
        for (unsigned corner = 0; corner < corner_count(boxes[size_t(b)]); ++corner)
            if (!is_in_range(apply(bones[b], corner_of(boxes[size_t(b)], corner))))
                throw InvalidInput(source + ": bone " + std::to_string(b) + " at " + std::to_string(time) +
                                   " s moves its vertices out of range; coordinates must be finite and at " +
                                   "most 100 km");
    }
}

} // namespace

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

    bone_boxes_ = boxes_of_bones(avatar_->skin(), avatar_->bone_count());
    shape_reaches_ = reaches_of_shapes(avatar_->skin(), avatar_->bone_count());
    bones_t1_.resize(size_t(avatar_->bone_count()));
    show(at(0.0), root_transform);
    bones_t0_ = bones_t1_;
}

PoseAt MovingAvatar::at(double t) const
{
    return pose_at(motion_, clip_, clip_ < 0 ? 0.0 : avatar_->clips()[clip_].duration, t);
}

std::optional<double> MovingAvatar::end_time() const
{
    if (clip_ < 0 || motion_.loop || motion_.speed == 0.0)
        return std::nullopt;
    return avatars::end_time(motion_, avatar_->clips()[size_t(clip_)].duration);
}

PoseAt MovingAvatar::shape_at(double t) const
{
    PoseAt shape = at(t);
    shape.cycles = 0;
    return shape;
}

void MovingAvatar::show(const PoseAt& at, const Affine& root_transform)
{
    if (is_posed_ahead_ && at == ahead_ && root_transform == ahead_root_transform_)
        bones_t1_.swap(bones_ahead_);
    else
        avatar_->pose_bones(at, compose(root_transform, world_from_avatar_), bones_t1_);
    is_posed_ahead_ = false;
    require_in_range(bones_t1_, bone_boxes_, at.time, avatar_->source());
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

/// A vertex moves by a weighted mean of its bones' displacements of its shaped position r: (A - A') r + b -
/// b', and by A' times the change of r.
double MovingAvatar::max_motion_to(double t, const Affine& root_transform)
{
    const PoseAt next = at(t);
    if (next == shown_ && root_transform == shown_root_transform_)
        return 0.0;
    bones_ahead_.resize(bones_t1_.size());
    avatar_->pose_bones(next, compose(root_transform, world_from_avatar_), bones_ahead_);
    ahead_ = next;
    ahead_root_transform_ = root_transform;
    is_posed_ahead_ = true;

    // Bound the shapes' displacement of a vertex, and its change [mesh units].
    double shaped = 0.0, change = 0.0;
    const size_t first_shape = bones_t1_.size() - shape_reaches_.size();
    for (size_t s = 0; s < shape_reaches_.size(); ++s) {
        const double weight_t1 = bones_t1_[first_shape + s](0, 0);
        const double weight_ahead = bones_ahead_[first_shape + s](0, 0);
        shaped += std::abs(weight_ahead) * shape_reaches_[s];
        change += std::abs(weight_ahead - weight_t1) * shape_reaches_[s];
    }

    double largest = 0.0;
    for (size_t b = 0; b < first_shape; ++b)
        if (!bone_boxes_[b].empty()) {
            const Bounds reached{bone_boxes_[b].lower.array() - shaped,
                                 bone_boxes_[b].upper.array() + shaped};
            // The Frobenius norm bounds how far a map stretches.
            largest = std::max(largest, max_distance(reached, bones_t1_[b], bones_ahead_[b]) +
                                            change * bones_t1_[b].leftCols<3>().norm());
        }
    return largest;
}

} // namespace toile::avatars
