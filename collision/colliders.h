#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include <Eigen/Geometry>

#include "collision/motion_bounds.h"
#include "collision/shapes.h"
#include "collision/surface_proximity.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// A triangle surface that cloth may touch, at the end t1 of the current step; still or moving.
///
/// Built once. What searches of the host need of a pose is found when they first ask (stage
/// "collision/refit"): never for a mesh that stands, nor where a GPU makes the steps.
class MeshCollider {
public:
    /// Builds the tree. O(n log n). Any triangle list will do (see SurfaceProximity).
    explicit MeshCollider(const MovingMesh& mesh);

    /// The next step's positions: as many vertices as before, the same triangles. O(n). Not while others ask.
    void move(const MovingMesh& mesh);

    View<const Triangle> triangles() const { return surface_.triangles(); }
    View<const Vec3> x_t0() const { return x_t0_; }  ///< [vertices] [m]
    View<const Vec3> x_t1() const { return x_t1_; }  ///< [vertices] [m]
    const Bounds& bounds() const { return bounds_; } ///< at t1

    /// Steps in which it has moved so far.
    int move_count() const { return move_count_; }
    bool is_moving() const { return is_moving_; } ///< in the current step

    // These refit, once after a move, whoever asks first.

    const SurfaceProximity& surface() const { return refitted().surface_; }     ///< at t1
    const MotionBounds& last_motion() const { return refitted().last_motion_; } ///< how it moved last

    /// Both ends of the step, until the next move().
    MeshPose pose() const { return {surface().view(), x_t0_}; }

    /// Displacement of a vertex from t0 to t1 [m].
    Vec3 motion(int vertex) const { return pose().motion(vertex); }

    /// Displacement of a point of a triangle from t0 to t1 [m].
    Vec3 motion(int triangle, const Vec3& barycentric) const { return pose().motion(triangle, barycentric); }

    struct OwnedEdge {
        int edge;
        std::array<int, 2> vertex;
    };

    bool is_ridge(int edge) const { return surface().view().is_ridge(edge); } ///< see SurfaceView

    /// Edges whose lowest triangle is this one: every edge belongs to exactly one triangle.
    View<const OwnedEdge> owned_edges(int triangle) const
    {
        const int first = first_owned_[triangle];
        return {owned_edges_.data() + first, first_owned_[triangle + 1] - first};
    }

private:
    const MeshCollider& refitted() const
    {
        if (is_behind_.load(std::memory_order_acquire))
            refit();
        return *this;
    }
    void refit() const;

    mutable SurfaceProximity surface_;
    std::vector<Vec3> x_t0_, x_t1_, x_before_; ///< [vertices] [m]; the last before the last move
    std::vector<int> first_owned_;             ///< [triangles + 1] into owned_edges_
    std::vector<OwnedEdge> owned_edges_;       ///< [edges]
    Bounds bounds_;
    int move_count_ = 0;
    bool is_moving_ = false;
    mutable MotionBounds last_motion_;
    mutable std::mutex refitting_;
    mutable std::atomic<bool> is_behind_ = false; ///< surface_ and last_motion_, of what has moved
};

/// An analytic solid that moves rigidly during the step.
class ShapeCollider {
public:
    /// @param source  named in errors, e.g. the scene's path of the shape
    /// @throws InvalidInput for sizes that make no solid (see require_usable)
    ShapeCollider(const Shape& shape, const Eigen::Isometry3d& pose, const std::string& source);

    /// world_from_shape at both ends of the step.
    void move(const Eigen::Isometry3d& pose_t0, const Eigen::Isometry3d& pose_t1);

    /// The closest surface point at t1.
    ShapePoint closest(const Vec3& x) const { return toile::closest(shape_, pose_t1_, x); }

    /// Displacement from t0 to t1 [m] of the material point that is at `point` at t1.
    Vec3 motion(const Vec3& point) const { return point - pose_t0_ * (pose_t1_.inverse() * point); }

    const Shape& shape() const { return shape_; }
    const Eigen::Isometry3d& pose_t0() const { return pose_t0_; } ///< world_from_shape at t0
    const Eigen::Isometry3d& pose() const { return pose_t1_; }    ///< world_from_shape at t1

private:
    Shape shape_;
    Eigen::Isometry3d pose_t0_;
    Eigen::Isometry3d pose_t1_;
};

/// What cloth may touch: exactly one of mesh and shape is set. Borrowed; moved by their owner before each
/// step.
struct ContactPartner {
    const MeshCollider* mesh = nullptr;
    const ShapeCollider* shape = nullptr;
};

} // namespace toile
