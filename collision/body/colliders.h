#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include <Eigen/Geometry>

#include "collision/body/given_poses.h"
#include "collision/bvh/motion_bounds.h"
#include "collision/geometry/shapes.h"
#include "collision/geometry/surface_proximity.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

/// Triangle surface that cloth may contact, at the end t1 of the current step; still or moving.
///
/// Built once. Positions are evaluated on the host at the first request after a step begins, and the boxes
/// for searches after a move (stage "collision/refit"). A GPU step makes no requests, and a still mesh keeps
/// its boxes.
class MeshCollider {
public:
    /// Constructs a mesh with given positions and builds the tree. O(n log n). Any triangle list is valid
    /// (see SurfaceProximity).
    explicit MeshCollider(const MovingMesh& mesh);
    /// Sets the next step's positions: same triangles and number of vertices. O(n). Not during concurrent
    /// reads.
    void move(const MovingMesh& mesh);

    /// Constructs a mesh posed by `poses`, which are evaluated on demand.
    MeshCollider(View<const Triangle> triangles, std::shared_ptr<const MeshPoses> poses);
    /// Starts the next step of the poses. O(1). Not during concurrent reads.
    /// @param is_moving  true if t0 and t1 of the step differ
    void follow_poses(bool is_moving);

    const MeshPoses& poses() const { return *poses_; }
    View<const Triangle> triangles() const { return surface_.triangles(); }

    /// Number of steps in which the mesh has moved.
    int move_count() const { return move_count_; }
    bool is_moving() const { return is_moving_; } ///< in the current step

    // Accessors that evaluate the poses, once a step, at the first call.

    View<const Vec3> x_t0() const { return posed().x_t0_; }  ///< [vertices] [m]
    View<const Vec3> x_t1() const { return posed().x_t1_; }  ///< [vertices] [m]
    const Bounds& bounds() const { return posed().bounds_; } ///< at t1

    // Accessors that need boxes: they also refit, once after a move.

    const SurfaceProximity& surface() const { return refitted().surface_; }     ///< at t1
    const MotionBounds& last_motion() const { return refitted().last_motion_; } ///< since last evaluated

    /// Both ends of the step, valid until the next move().
    MeshPose pose() const { return {surface().view(), x_t0()}; }

    /// Displacement of a vertex from t0 to t1 [m].
    Vec3 motion(int vertex) const { return pose().motion(vertex); }

    /// Displacement of a point of a triangle from t0 to t1 [m].
    Vec3 motion(int triangle, const Vec3& barycentric) const { return pose().motion(triangle, barycentric); }

    struct OwnedEdge {
        int edge;
        std::array<int, 2> vertex;
    };

    bool is_ridge(int edge) const { return surface().view().is_ridge(edge); } ///< see SurfaceView

    /// Edges whose lowest triangle is this one; every edge belongs to exactly one triangle.
    View<const OwnedEdge> owned_edges(int triangle) const
    {
        const int first = first_owned_[triangle];
        return {owned_edges_.data() + first, first_owned_[triangle + 1] - first};
    }

private:
    MeshCollider(View<const Triangle> triangles, std::shared_ptr<GivenPoses> given);
    void begin_step(bool is_moving);
    const MeshCollider& posed() const
    {
        if (needs_pose_.load(std::memory_order_acquire))
            take_pose();
        return *this;
    }
    const MeshCollider& refitted() const
    {
        if (needs_refit_.load(std::memory_order_acquire))
            refit();
        return *this;
    }
    void take_pose() const;
    void refit() const;

    std::shared_ptr<const MeshPoses> poses_;
    std::shared_ptr<GivenPoses> given_;  ///< poses_ if positions are given
    std::vector<int> first_owned_;       ///< [triangles + 1] into owned_edges_
    std::vector<OwnedEdge> owned_edges_; ///< [edges]
    int move_count_ = 0;
    bool is_moving_ = false;

    // State evaluated on demand.
    mutable std::mutex asking_;
    mutable std::atomic<bool> needs_pose_ = false, needs_refit_ = false; ///< positions; surface and motion
    mutable int posed_at_ = 0;                                           ///< move_count_ of the positions
    mutable std::vector<Vec3> x_t0_, x_t1_, x_before_; ///< [vertices] [m]; x_before_: before the last move
    mutable Bounds bounds_;
    mutable SurfaceProximity surface_;
    mutable MotionBounds last_motion_;
};

/// Analytic solid that moves rigidly during the step.
class ShapeCollider {
public:
    /// @param source  named in errors, e.g. the scene's path of the shape
    /// @throws InvalidInput for sizes that form no solid (see require_usable)
    ShapeCollider(const Shape& shape, const Eigen::Isometry3d& pose, const std::string& source);

    /// Sets world_from_shape at both ends of the step.
    void move(const Eigen::Isometry3d& pose_t0, const Eigen::Isometry3d& pose_t1);

    /// Closest surface point at t1.
    ShapePoint closest(const Vec3& x) const { return toile::collision::closest(shape_, pose_t1_, x); }

    /// Displacement from t0 to t1 [m] of the material point that is at `point` at t1.
    Vec3 motion(const Vec3& point) const;

    const Shape& shape() const { return shape_; }
    const Eigen::Isometry3d& pose_t0() const { return pose_t0_; } ///< world_from_shape at t0
    const Eigen::Isometry3d& pose() const { return pose_t1_; }    ///< world_from_shape at t1

private:
    Shape shape_;
    Eigen::Isometry3d pose_t0_;
    Eigen::Isometry3d pose_t1_;
};

/// Collider of cloth: exactly one of mesh and shape is set. Borrowed; the owner moves them before each step.
struct ContactCollider {
    const MeshCollider* mesh = nullptr;
    const ShapeCollider* shape = nullptr;
};

} // namespace toile::collision
