#include "scenes/colliders/collider.h"

#include <algorithm>

#include "collision/geometry/shape_surface.h"
#include "core/base/stages.h"

namespace toile::scenes {

Collider::Collider(const scene::Avatar& settings, double default_friction)
    : body_(settings), friction_(settings.friction.value_or(default_friction))
{
    if (body_.shape() && std::holds_alternative<collision::BoxShape>(*body_.shape())) {
        box_ = collision::shape_surface(*body_.shape(), 0.0);
        mesh_collider_ = std::make_unique<collision::MeshCollider>(sides(body_.pose()));
        return;
    }
    if (body_.shape()) {
        shape_collider_ =
            std::make_unique<collision::ShapeCollider>(*body_.shape(), body_.pose(), settings.name);
        return;
    }
    mesh_collider_ =
        std::make_unique<collision::MeshCollider>(body_.skinned()->contact_triangles(), body_.skinned());
}

void Collider::advance_to(double t_t1)
{
    if (body_.is_static())
        return;
    const StageScope stage("avatars/advance");
    const Eigen::Isometry3d pose_t0 = body_.pose();
    const bool was_moving = moved_;
    moved_ = body_.advance_to(t_t1);
    if (!moved_ && !was_moving)
        return;
    if (shape_collider_)
        shape_collider_->move(pose_t0, body_.pose());
    else if (!box_.triangles.empty())
        mesh_collider_->move(sides(pose_t0));
    else
        mesh_collider_->follow_poses(moved_);
}

Collider::SurfacePoint Collider::closest(const Vec3& x) const
{
    if (shape_collider_) {
        const collision::ShapePoint at = shape_collider_->closest(x);
        return {at.point, at.normal, at.signed_distance};
    }
    const collision::SurfacePoint at = *mesh_collider_->surface().closest(x);
    return {at.point, at.normal, at.signed_distance};
}

/// Sides of the box from one pose to its present one.
MovingMesh Collider::sides(const Eigen::Isometry3d& pose_t0) const
{
    MovingMesh mesh{box_.triangles, box_.positions, box_.positions};
    for (size_t i = 0; i < box_.positions.size(); ++i) {
        mesh.x_t0[i] = pose_t0 * box_.positions[i];
        mesh.x_t1[i] = body_.pose() * box_.positions[i];
    }
    return mesh;
}

int index_of(const std::vector<Collider>& colliders, const std::string& name)
{
    const auto found = std::find_if(colliders.begin(), colliders.end(),
                                    [&](const Collider& collider) { return collider.name() == name; });
    return found == colliders.end() ? -1 : int(found - colliders.begin());
}

} // namespace toile::scenes
