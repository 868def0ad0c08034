#pragma once

#include <vector>

#include "collision/body/mesh_poses.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

/// Poses of a mesh that are given as positions.
class GivenPoses final : public MeshPoses {
public:
    explicit GivenPoses(const MovingMesh& mesh) : x_t0_(mesh.x_t0), x_t1_(mesh.x_t1) {}

    /// Sets the positions of the next step. False if x_t1 is unchanged.
    bool move(const MovingMesh& mesh);

    View<const Vec3> x_t0() const { return x_t0_; } ///< [vertices] [m]
    View<const Vec3> x_t1() const { return x_t1_; } ///< [vertices] [m]

    int vertex_count() const override { return int(x_t1_.size()); }
    void pose_t0(View<Vec3> x) const override;
    void pose_t1(View<Vec3> x) const override;
    std::unique_ptr<DeviceMeshPoses> on_device(const CudaSpace& space) const override;

private:
    std::vector<Vec3> x_t0_, x_t1_;
};

} // namespace toile::collision
