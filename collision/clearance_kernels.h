#pragma once

/// What a Clearance follows and learns by. The same bodies on CPU and GPU.

#include "collision/motion_bounds.h"

namespace toile {

/// What rounding may take of a bound [m].
inline constexpr double kClearanceRounding = 1e-9;

/// From a displacement to the farthest one of a box of them [m].
TOILE_HD inline double farthest(const Vec3& motion, const Bounds& others)
{
    return (motion - others.lower).cwiseAbs().cwiseMax((motion - others.upper).cwiseAbs()).norm();
}

/// Takes a bound to where cloth and mesh are now.
struct FollowClearance {
    /// What the mesh has done since the bound was known.
    enum class Mesh { kStood, kMovedOnce, kUnknown };
    /// @param then, now  MeshCollider::move_count()
    static Mesh since(int then, int now)
    {
        return now == then ? Mesh::kStood : now == then + 1 ? Mesh::kMovedOnce : Mesh::kUnknown;
    }

    View<const Vec3> x; ///< [vertices] now [m]
    Mesh mesh;
    MotionView motion;  ///< of the mesh, in its last move
    View<Vec3> x_then;  ///< [vertices] that the bounds are for [m]; in, out
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
                                     : before - farthest(moved, *others) - kClearanceRounding;
        }
        bound[v] = left > 0.0 ? left : 0.0;
    }
};

/// What a search has found in front of a mesh.
struct LearnClearance {
    View<const double> in_front; ///< [vertices] [m]; negative: it was not looked for
    View<double> bound;          ///< [vertices] in, out [m]
    TOILE_HD void operator()(int v) const
    {
        if (in_front[v] >= 0.0)
            bound[v] = in_front[v] < MotionView::kReach ? in_front[v] : MotionView::kReach;
    }
};

/// What is known where nothing of a mesh is within `distance` of any vertex.
struct LearnFar {
    double distance;    ///< [m]
    View<double> bound; ///< [vertices] out [m]
    TOILE_HD void operator()(int v) const
    {
        bound[v] = distance < MotionView::kReach ? distance : MotionView::kReach;
    }
};

} // namespace toile
