#include "scenes/colliders/collider.h"

#include "core/base/stages.h"

namespace toile::scenes {

Collider::Collider(const scene::Avatar& settings, double default_friction)
    : body_(settings), friction_(settings.friction.value_or(default_friction))
{
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
    else
        mesh_collider_->follow_poses(moved_);
}

} // namespace toile::scenes
