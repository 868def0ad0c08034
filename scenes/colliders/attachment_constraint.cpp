#include "scenes/colliders/attachment_constraint.h"

#include <algorithm>
#include <cmath>

#include "core/compute/parallel.h"

namespace toile::scenes {

namespace {

/// Acceleration [m/s^2] at which springs still hold cloth on an avatar: three times that of gravity.
constexpr double kMaxAcceleration = 30.0;

/// Stretch [m] of springs to an avatar under the load of the whole cloth.
constexpr double kMaxStretch = 1e-3;

Vec3 mean_of(View<const Vec3> x, const std::vector<int>& vertices)
{
    Vec3 sum = Vec3::Zero();
    for (const int v : vertices)
        sum += x[v];
    return sum / double(vertices.size());
}

} // namespace

AttachmentConstraint::AttachmentConstraint(const scene::Attachment& settings, std::vector<int> vertices,
                                           View<const Vec3> start, const std::vector<Collider>& colliders,
                                           std::optional<double> mass, const std::string& location)
    : settings_(settings), location_(location), vertices_(std::move(vertices))
{
    if (settings.to == scene::kFixed) {
        motion_ = RigidMotion(settings.keyframes, settings.pivot.value_or(mean_of(start, vertices_)));
        return;
    }
    collider_ = index_of(colliders, settings.to);
    if (!settings.exact && !settings.stiffness && mass)
        settings_.stiffness = std::max(scene::kSkinStiffness,
                                       kMaxAcceleration * *mass / (kMaxStretch * double(vertices_.size())));
}

void AttachmentConstraint::tie(View<const Vec3> x, View<const Triangle> triangles, double gap,
                               const std::vector<Collider>& colliders)
{
    start_.clear();
    for (const int v : vertices_)
        start_.push_back(x[v]);
    if (!is_on_avatar())
        return;
    const Collider& collider = colliders[collider_];
    shape_from_world_ = collider.body().pose().inverse();
    const std::vector<double> clearance = clearances(collider, x, triangles, gap);
    farthest_ = {};
    for (size_t k = 0; k < start_.size(); ++k) {
        const Collider::SurfacePoint skin = collider.closest(start_[k]);
        if (skin.signed_distance > farthest_.distance)
            farthest_ = {vertices_[k], skin.signed_distance};
        if (skin.signed_distance < clearance[k])
            start_[k] = skin.point + clearance[k] * skin.normal;
    }
    if (collider.body().skinned())
        tie_to_skin(*collider.contact_collider().mesh);
}

/// Height to keep above the skin at each attached vertex [m]: the gap, and the sagitta by which the edges
/// between attached vertices dip below it, length times turn of the normal over 8.
std::vector<double> AttachmentConstraint::clearances(const Collider& collider, View<const Vec3> x,
                                                     View<const Triangle> triangles, double gap) const
{
    std::vector<int> number(x.size(), -1);
    std::vector<Vec3> normal;
    for (size_t k = 0; k < vertices_.size(); ++k) {
        number[vertices_[k]] = int(k);
        normal.push_back(collider.closest(x[vertices_[k]]).normal);
    }
    std::vector<double> clearance(vertices_.size(), gap);
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const int v = t[k], w = t[(k + 1) % 3], a = number[v], b = number[w];
            if (a < 0 || b < 0)
                continue;
            const double turn = 2.0 * std::asin(std::min(1.0, 0.5 * (normal[a] - normal[b]).norm()));
            const double height = gap + 0.125 * turn * (x[v] - x[w]).norm();
            clearance[a] = std::max(clearance[a], height);
            clearance[b] = std::max(clearance[b], height);
        }
    return clearance;
}

void AttachmentConstraint::tie_to_skin(const collision::MeshCollider& mesh)
{
    patches_.clear();
    anchors_.clear();
    const std::vector<Vec3> normals = vertex_normals(mesh.x_t1(), mesh.triangles());
    std::vector<int> index(normals.size(), -1);
    for (const Vec3& x : start_)
        patches_.emplace_back(mesh, normals, *mesh.surface().closest(x), index, anchors_);
    anchored_.resize(anchors_.size());
}

void AttachmentConstraint::follow(double t, const std::vector<Collider>& colliders)
{
    if (collider_ < 0) {
        world_from_start_ = motion_.at(t);
        return;
    }
    const BodyMotion& body = colliders[collider_].body();
    if (patches_.empty()) {
        world_from_start_ = body.pose() * shape_from_world_;
        return;
    }
    const SkinnedCollider& skinned = *body.skinned();
    parallel_for(kCpu, "scenes/anchors", int(anchors_.size()),
                 [&](int i) { anchored_[i] = skinned.vertex_t1(anchors_[i]); });
}

Vec3 AttachmentConstraint::target(int k) const
{
    return patches_.empty() ? world_from_start_ * start_[k] : patches_[k].moved(start_[k], anchored_);
}

} // namespace toile::scenes
