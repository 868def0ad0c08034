#include "collision/body/colliders.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Positions at one end of a step.
std::vector<Vec3> positions(const MeshPoses& poses, void (MeshPoses::*pose)(View<Vec3>) const)
{
    std::vector<Vec3> x(size_t(poses.vertex_count()));
    (poses.*pose)(x);
    return x;
}

} // namespace

MeshCollider::MeshCollider(View<const Triangle> triangles, std::shared_ptr<const MeshPoses> poses)
    : poses_(std::move(poses)), first_owned_(size_t(triangles.size()) + 1, 0),
      x_t0_(positions(*poses_, &MeshPoses::pose_t0)), x_t1_(positions(*poses_, &MeshPoses::pose_t1)),
      bounds_(toile::bounds(x_t1_)), surface_(triangles, x_t1_)
{
    // Group edges by their lowest triangle.
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

MeshCollider::MeshCollider(View<const Triangle> triangles, std::shared_ptr<GivenPoses> given)
    : MeshCollider(triangles, std::shared_ptr<const MeshPoses>(given))
{
    given_ = std::move(given);
}

MeshCollider::MeshCollider(const MovingMesh& mesh)
    : MeshCollider(mesh.triangles, std::make_shared<GivenPoses>(mesh))
{
}

void MeshCollider::move(const MovingMesh& mesh)
{
    TOILE_ASSERT(given_ != nullptr);
    begin_step(given_->move(mesh));
}

void MeshCollider::follow_poses(bool is_moving)
{
    TOILE_ASSERT(given_ == nullptr);
    begin_step(is_moving);
}

void MeshCollider::begin_step(bool is_moving)
{
    is_moving_ = is_moving;
    needs_pose_ = true;
    if (!is_moving)
        return;
    ++move_count_;
    needs_refit_ = true;
}

/// Evaluates the poses. If positions were not requested in the step before, the last motion spans several
/// steps.
void MeshCollider::take_pose() const
{
    const std::lock_guard lock(asking_);
    if (!needs_pose_)
        return;
    parallel_isolated(kCpu, [&] { // a task stolen here could request positions under the lock
        poses_->pose_t0(x_t0_);
        if (posed_at_ == move_count_)
            return;
        x_before_.swap(x_t1_);
        x_t1_.resize(x_t0_.size());
        poses_->pose_t1(x_t1_);
        bounds_ = toile::bounds(x_t1_);
    });
    posed_at_ = move_count_;
    needs_pose_ = false;
}

void MeshCollider::refit() const
{
    (void)posed();
    const std::lock_guard lock(asking_);
    if (!needs_refit_)
        return;
    const StageScope stage("collision/refit");
    parallel_isolated(kCpu, [&] { // see take_pose()
        last_motion_.build(triangles(), x_before_, x_t1_, bounds_);
        surface_.update(x_t1_);
    });
    needs_refit_ = false;
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

Vec3 ShapeCollider::motion(const Vec3& point) const
{
    return point - pose_t0_ * (pose_t1_.inverse() * point);
}

} // namespace toile::collision
