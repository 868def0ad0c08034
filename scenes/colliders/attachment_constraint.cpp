#include "scenes/colliders/attachment_constraint.h"

#include <algorithm>
#include <map>

#include "core/base/error.h"
#include "core/compute/parallel.h"

namespace toile::scenes {

namespace {

/// Minimum height [m] above an avatar's surface of a vertex attached to it.
constexpr double kMinHeight = 0.0005;

/// Orthonormal frame of a triangle: first edge, in-plane normal to it, normal.
Mat3 frame_of(const Vec3& a, const Vec3& b, const Vec3& c)
{
    const Vec3 edge = b - a;
    const Vec3 normal = edge.cross(c - a);
    Mat3 frame;
    frame.col(0) = edge.normalized();
    frame.col(2) = normal.normalized();
    frame.col(1) = frame.col(2).cross(frame.col(0));
    return frame;
}

int nearest_vertex(View<const Vec3> x, const Vec3& point)
{
    int best = 0;
    for (int v = 1; v < x.size(); ++v)
        if ((x[v] - point).squaredNorm() < (x[best] - point).squaredNorm())
            best = v;
    return best;
}

double distance_to(const Collider& collider, const Vec3& x)
{
    const collision::ContactCollider contact_collider = collider.contact_collider();
    if (contact_collider.shape)
        return contact_collider.shape->closest(x).signed_distance;
    return contact_collider.mesh->surface().closest(x)->signed_distance;
}

int index_of(const std::vector<Collider>& colliders, const std::string& name)
{
    const auto found = std::find_if(colliders.begin(), colliders.end(),
                                    [&](const Collider& collider) { return collider.name() == name; });
    return found == colliders.end() ? -1 : int(found - colliders.begin());
}

} // namespace

AttachmentConstraint::AttachmentConstraint(const scene::Attachment& settings, View<const Vec3> start,
                                           const std::vector<Collider>& colliders,
                                           const std::string& location)
    : settings_(settings), motion_(settings.keyframes, Vec3::Zero())
{
    select(start, colliders, location);
    if (vertices_.empty())
        throw InvalidInput(location + ": selects no vertex of \"" + settings.cloth +
                           "\"; move the selection to where the cloth starts");
    for (const int v : vertices_)
        start_.push_back(start[v]);
    if (settings.to != scene::kFixed) {
        collider_ = index_of(colliders, settings.to);
        tie(colliders[collider_]);
    }
}

void AttachmentConstraint::select(View<const Vec3> start, const std::vector<Collider>& colliders,
                                  const std::string& location)
{
    if (const auto* indices = std::get_if<std::vector<int>>(&settings_.select.by)) {
        for (const int v : *indices)
            if (v < 0 || v >= start.size())
                throw InvalidInput(location + ": vertex " + std::to_string(v) + " is out of range; \"" +
                                   settings_.cloth + "\" has vertices 0 to " +
                                   std::to_string(start.size() - 1));
        vertices_ = *indices;
    } else if (const auto* points = std::get_if<std::vector<Vec3>>(&settings_.select.by)) {
        for (const Vec3& point : *points)
            vertices_.push_back(nearest_vertex(start, point));
    } else if (const auto* box = std::get_if<scene::SelectBox>(&settings_.select.by)) {
        for (int v = 0; v < start.size(); ++v)
            if ((start[v].array() >= box->lower.array()).all() &&
                (start[v].array() <= box->upper.array()).all())
                vertices_.push_back(v);
    } else {
        const auto& near = std::get<scene::SelectNearAvatar>(settings_.select.by);
        const Collider& collider = colliders[index_of(colliders, near.avatar)];
        for (int v = 0; v < start.size(); ++v)
            if (distance_to(collider, start[v]) <= near.distance)
                vertices_.push_back(v);
    }
    std::sort(vertices_.begin(), vertices_.end());
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
}

void AttachmentConstraint::tie(const Collider& collider)
{
    shape_from_world_ = collider.body().pose().inverse();
    if (collider.contact_collider().shape)
        return;
    const collision::MeshCollider& mesh = *collider.contact_collider().mesh;
    std::map<int, int> anchor_of;
    for (const Vec3& x : start_) {
        const collision::SurfacePoint at = *mesh.surface().closest(x);
        const Triangle& corner = mesh.triangles()[at.triangle];
        const Mat3 frame = frame_of(mesh.x_t1()[corner[0]], mesh.x_t1()[corner[1]], mesh.x_t1()[corner[2]]);
        SurfaceTie tie{{}, at.barycentric, frame.transpose() * (x - at.point)};
        if (at.signed_distance < kMinHeight) // starts inside: attached to the surface, not below it
            tie.offset = kMinHeight * Vec3::UnitZ();
        for (int c = 0; c < 3; ++c) {
            const auto [anchor, is_new] = anchor_of.emplace(corner[c], int(anchors_.size()));
            if (is_new)
                anchors_.push_back(corner[c]);
            tie.corner[size_t(c)] = anchor->second;
        }
        ties_.push_back(tie);
    }
    anchored_.resize(anchors_.size());
}

void AttachmentConstraint::follow(double t, const std::vector<Collider>& colliders)
{
    if (collider_ < 0) {
        world_from_start_ = motion_.at(t);
        return;
    }
    const BodyMotion& body = colliders[collider_].body();
    if (ties_.empty()) {
        world_from_start_ = body.pose() * shape_from_world_;
        return;
    }
    const SkinnedCollider& skinned = *body.skinned();
    parallel_for(kCpu, "scenes/anchors", int(anchors_.size()),
                 [&](int i) { anchored_[i] = skinned.vertex_t1(anchors_[i]); });
}

Vec3 AttachmentConstraint::target(int k) const
{
    if (ties_.empty())
        return world_from_start_ * start_[k];
    const SurfaceTie& tie = ties_[k];
    const Vec3 &a = anchored_[tie.corner[0]], &b = anchored_[tie.corner[1]], &c = anchored_[tie.corner[2]];
    return tie.barycentric[0] * a + tie.barycentric[1] * b + tie.barycentric[2] * c +
           frame_of(a, b, c) * tie.offset;
}

} // namespace toile::scenes
