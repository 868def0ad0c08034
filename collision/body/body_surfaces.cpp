#include "collision/body/body_surfaces.h"

#include <algorithm>

#include "collision/geometry/distance.h"
#include "collision/geometry/shape_surface.h"

namespace toile::collision {

BodySurfaces::BodySurfaces(const std::vector<ContactCollider>& colliders, double sag) : colliders_(colliders)
{
    for (int number = 0; number < int(colliders.size()); ++number) {
        const ContactCollider& collider = colliders[number];
        const bool is_open = collider.mesh != nullptr && !collider.mesh->surface().edges().is_closed;
        is_open_.push_back((unsigned char)(is_open ? 1 : 0));
        Part part{collider, number, vertex_count_, 0, {}, false};
        View<const Triangle> triangles;
        TriangleMesh facets;
        if (collider.mesh) {
            triangles = collider.mesh->triangles();
            part.count = collider.mesh->x_t1().size();
        } else {
            facets = shape_surface(collider.shape->shape(), sag);
            triangles = facets.triangles;
            part.count = facets.vertex_count();
            part.facets = std::move(facets.positions);
        }
        for (const Triangle& t : triangles)
            triangles_.push_back(t + Triangle::Constant(vertex_count_));
        vertex_count_ += part.count;
        if (part.count > 0)
            parts_.push_back(std::move(part));
    }
}

bool BodySurfaces::is_moving(const Part& part)
{
    const ContactCollider& collider = part.collider;
    return !part.jumps &&
           (collider.mesh ? collider.mesh->is_moving()
                          : collider.shape->pose_t0().matrix() != collider.shape->pose().matrix());
}

bool BodySurfaces::is_moving() const
{
    return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return is_moving(part); });
}

bool BodySurfaces::has_jumped() const
{
    return std::any_of(parts_.begin(), parts_.end(), [](const Part& part) { return part.jumps; });
}

bool BodySurfaces::find_jumps(double dt)
{
    bool any = false;
    for (Part& part : parts_) {
        part.jumps = false;
        if (!is_moving(part))
            continue;
        std::vector<Vec3> x(part.count), y(part.count);
        pose(part, x, false);
        pose(part, y, true);
        for (int v = 0; v < part.count && !part.jumps; ++v)
            part.jumps = !((y[v] - x[v]).norm() <= kMaxSpeed * dt);
        any = any || part.jumps;
    }
    return any;
}

std::vector<int> BodySurfaces::colliders() const
{
    std::vector<int> numbers;
    for (const Part& part : parts_)
        numbers.insert(numbers.end(), part.count, part.number);
    return numbers;
}

std::vector<unsigned char> BodySurfaces::are_open() const
{
    std::vector<unsigned char> open;
    for (const Part& part : parts_)
        open.insert(open.end(), part.count, is_open_[part.number]);
    return open;
}

bool BodySurfaces::is_inside(const Vec3& x) const
{
    for (int c = 0; c < int(colliders_.size()); ++c) {
        const ContactCollider& collider = colliders_[c];
        if (collider.shape) {
            if (!std::holds_alternative<PlaneShape>(collider.shape->shape()) &&
                collider.shape->closest(x).signed_distance < 0.0)
                return true;
        } else if (is_open_[c] == 0) {
            const std::optional<SurfacePoint> at = collider.mesh->surface().closest(x);
            if (at && at->signed_distance < 0.0)
                return true;
        }
    }
    return false;
}

Vec3 BodySurfaces::normal_at(const NearestSurface& at, const Vec3& x) const
{
    const ContactCollider& collider = colliders_[at.collider];
    if (collider.shape)
        return collider.shape->closest(x).normal;
    const View<const Vec3> y = collider.mesh->x_t1();
    const Triangle& t = collider.mesh->triangles()[at.feature];
    return (y[t[1]] - y[t[0]]).cross(y[t[2]] - y[t[0]]).normalized();
}

Vec3 BodySurfaces::motion_of(const NearestSurface& at, const Vec3& x) const
{
    const bool jumps = std::any_of(parts_.begin(), parts_.end(), [&](const Part& part) {
        return part.number == at.collider && part.jumps;
    });
    if (jumps)
        return Vec3::Zero();
    const ContactCollider& collider = colliders_[at.collider];
    if (collider.shape)
        return collider.shape->pose() * (collider.shape->pose_t0().inverse() * x) - x;
    const Triangle& t = collider.mesh->triangles()[at.feature];
    const View<const Vec3> from = collider.mesh->x_t0(), to = collider.mesh->x_t1();
    return (to[t[0]] + to[t[1]] + to[t[2]] - from[t[0]] - from[t[1]] - from[t[2]]) / 3.0;
}

double BodySurfaces::distance_to(const NearestSurface& at, const Vec3& x) const
{
    const ContactCollider& collider = colliders_[at.collider];
    if (collider.shape)
        return std::abs(collider.shape->closest(x).signed_distance);
    const View<const Vec3> y = collider.mesh->x_t1();
    const Triangle& t = collider.mesh->triangles()[at.feature];
    return (x - closest_on_triangle(x, y[t[0]], y[t[1]], y[t[2]]).point).norm();
}

void BodySurfaces::pose_t0(View<Vec3> x) const
{
    for (const Part& part : parts_)
        pose(part, x.subview(part.first, part.count), part.jumps);
}

void BodySurfaces::pose_t1(View<Vec3> x) const
{
    for (const Part& part : parts_)
        pose(part, x.subview(part.first, part.count), true);
}

void BodySurfaces::pose(const Part& part, View<Vec3> x, bool is_end) const
{
    if (part.collider.mesh) {
        const View<const Vec3> from = is_end ? part.collider.mesh->x_t1() : part.collider.mesh->x_t0();
        std::copy(from.begin(), from.end(), x.begin());
        return;
    }
    const Eigen::Isometry3d& pose = is_end ? part.collider.shape->pose() : part.collider.shape->pose_t0();
    std::transform(part.facets.begin(), part.facets.end(), x.begin(),
                   [&](const Vec3& p) { return pose * p; });
}

} // namespace toile::collision
