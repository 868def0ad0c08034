#include "collision/colliders.h"

#include <algorithm>

#include "core/backend/parallel.h"

namespace toile {

MeshCollider::MeshCollider(const MovingMesh& mesh)
    : surface_(mesh.triangles, mesh.x_t1), x_t0_(mesh.x_t0), x_t1_(mesh.x_t1),
      first_owned_(mesh.triangles.size() + 1, 0), bounds_(toile::bounds(mesh.x_t1))
{
    // Edges by their lowest triangle.
    const SurfaceEdges& edges = surface_.edges();
    for (int e = 0; e < edges.edge_count(); ++e)
        ++first_owned_[edges.triangles.of(e)[0] + 1];
    for (size_t t = 1; t < first_owned_.size(); ++t)
        first_owned_[t] += first_owned_[t - 1];
    owned_edges_.resize(edges.vertex.size());
    std::vector<int> next(first_owned_.begin(), first_owned_.end() - 1);
    for (int e = 0; e < edges.edge_count(); ++e)
        owned_edges_[next[edges.triangles.of(e)[0]]++] = {e, edges.vertex[e]};
}

void MeshCollider::move(const MovingMesh& mesh)
{
    TOILE_ASSERT(mesh.x_t1.size() == x_t1_.size());
    x_t0_ = mesh.x_t0;
    is_moving_ = mesh.x_t1 != x_t1_;
    if (!is_moving_)
        return;
    ++move_count_;
    x_before_.swap(x_t1_);
    x_t1_ = mesh.x_t1;
    bounds_ = toile::bounds(x_t1_);
    is_behind_ = true;
}

void MeshCollider::refit() const
{
    const std::lock_guard lock(refitting_);
    if (!is_behind_)
        return;
    const StageScope stage("collision/refit");
    parallel_isolated(kCpu, [&] { // else a task of who asks could be taken on here, and ask
        last_motion_.build(triangles(), x_before_, x_t1_, bounds_);
        surface_.update(x_t1_);
    });
    is_behind_ = false;
}

ShapeCollider::ShapeCollider(const Shape& shape, const Eigen::Isometry3d& pose, const std::string& source)
    : shape_(shape), pose_t0_(pose), pose_t1_(pose)
{
    require_usable(shape, source);
}

void ShapeCollider::move(const Eigen::Isometry3d& pose_t0, const Eigen::Isometry3d& pose_t1)
{
    pose_t0_ = pose_t0;
    pose_t1_ = pose_t1;
}

} // namespace toile
