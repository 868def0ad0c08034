#include "scenes/obstacle.h"

#include "core/backend/stages.h"

namespace toile {

Obstacle::Obstacle(const scene::Avatar& settings, double default_friction)
    : body_(settings), friction_(settings.friction.value_or(default_friction))
{
    if (body_.shape()) {
        shape_collider_ = std::make_unique<ShapeCollider>(*body_.shape(), body_.pose(), settings.name);
        return;
    }
    const TriangleMesh& surface = body_.contact_surface();
    mesh_ = {surface.triangles, surface.positions, surface.positions};
    mesh_collider_ = std::make_unique<MeshCollider>(mesh_);
}

void Obstacle::advance_to(double t_t1)
{
    const Eigen::Isometry3d pose_t0 = body_.pose();
    const bool was_moving = moved_;
    moved_ = !body_.is_static() && body_.advance_to(t_t1);
    if (!moved_ && !was_moving)
        return;
    const StageScope stage("avatars/advance");
    if (shape_collider_) {
        shape_collider_->move(pose_t0, body_.pose());
        return;
    }
    mesh_.x_t0.swap(mesh_.x_t1);
    mesh_.x_t1 = body_.contact_surface().positions;
    mesh_collider_->move(mesh_);
}

} // namespace toile
