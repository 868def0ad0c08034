#pragma once

/// Kernels that update a Clearance, with the same bodies on CPU and GPU.

#include "collision/bvh/motion_bounds.h"

namespace toile::collision {

/// Rounding error of a bound, subtracted at every update [m].
inline constexpr double kClearanceRounding = 1e-9;

/// Maximum distance from a displacement to the displacements in a box [m].
TOILE_HD inline double max_distance(const Vec3& motion, const Bounds& others)
{
    return (motion - others.lower).cwiseAbs().cwiseMax((motion - others.upper).cwiseAbs()).norm();
}

/// Updates a bound to the present positions of cloth and mesh.
struct FollowClearance {
    /// Motion of the mesh since the bound was computed.
    enum class Mesh { kStood, kMovedOnce, kUnknown };
    /// @param then, now  MeshCollider::move_count()
    static Mesh since(int then, int now)
    {
        return now == then ? Mesh::kStood : now == then + 1 ? Mesh::kMovedOnce : Mesh::kUnknown;
    }

    View<const Vec3> x; ///< [vertices] present positions [m]
    Mesh mesh;
    MotionView motion;  ///< of the mesh in its last move
    View<Vec3> x_then;  ///< [vertices] positions of the bounds [m]; in, out
    View<double> bound; ///< [vertices] in, out [m]

    TOILE_HD void operator()(int v) const
    {
        const Vec3 moved = x[v] - x_then[v];
        x_then[v] = x[v];
        double left = 0.0;
        if (mesh == Mesh::kStood)
            left = bound[v] - (moved.norm() + kClearanceRounding);
        else if (mesh == Mesh::kMovedOnce) {
            const Bounds* const others = motion.around(x[v]);
            const double before = bound[v] < MotionView::kReach ? bound[v] : MotionView::kReach;
            left = others == nullptr ? MotionView::kReach
                                     : before - max_distance(moved, *others) - kClearanceRounding;
        }
        bound[v] = left > 0.0 ? left : 0.0;
    }
};

/// Takes over the distances that a search has found in front of a mesh.
struct UpdateClearance {
    View<const double> in_front; ///< [vertices] [m]; negative: not searched
    View<double> bound;          ///< [vertices] in, out [m]
    TOILE_HD void operator()(int v) const
    {
        if (in_front[v] >= 0.0)
            bound[v] = in_front[v] < MotionView::kReach ? in_front[v] : MotionView::kReach;
    }
};

/// Sets the bounds if no part of a mesh lies within `distance` of any vertex.
struct UpdateFarClearance {
    double distance;    ///< [m]
    View<double> bound; ///< [vertices] out [m]
    TOILE_HD void operator()(int v) const
    {
        bound[v] = distance < MotionView::kReach ? distance : MotionView::kReach;
    }
};

} // namespace toile::collision
