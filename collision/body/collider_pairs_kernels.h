#pragma once

/// Kernels of ColliderPairs for each cloth vertex, with the same bodies on CPU and GPU.

#include <limits>

#include <Eigen/Geometry>

#include "collision/bvh/motion_bounds.h"
#include "collision/geometry/contact_pair.h"
#include "collision/geometry/surface_view.h"

namespace toile::collision {

/// Maximum search radius of meshes [m]. Cloth that moves further relative to one in a step is stopped by the
/// collision-free step.
inline constexpr double kMaxReach = 0.06;

/// Distance [m] by which the solver may move cloth from its prediction before another search is needed.
inline constexpr double kReachMargin = 0.003;

/// Search radius of vertices whose pairs are kept.
inline constexpr double kNowhere = -std::numeric_limits<double>::infinity();

/// Surface point nearest to a cloth vertex.
struct NearestSurface {
    int collider = -1; ///< -1: none near
    int feature = -1;
    double gap = 0.0;          ///< [m]
    Vec3 point = Vec3::Zero(); ///< [m]

    /// Replaces the point by that of a pair of the vertex if it is nearer.
    /// @param x  [vertices] positions at which the pair was found [m]
    TOILE_HD void consider(const ContactPair& pair, View<const Vec3> x)
    {
        const double other = pair.gap(x);
        if (collider >= 0 && !(other < gap))
            return;
        collider = pair.collider;
        feature = pair.feature;
        gap = other;
        point = pair.point;
    }
};

/// ContactCollider that advects cloth.
struct AdvectingCollider {
    bool is_mesh = false;
    bool is_moving = false;                   ///< of a mesh: in this step
    MeshPose mesh;                            ///< of a mesh
    MotionView motion;                        ///< of a mesh: in its last move
    Eigen::Isometry3d pose_t1, shape_from_t0; ///< of a shape: world_from_shape at t1, and its inverse at t0

    /// Displacement during the step [m] of a point on its surface.
    TOILE_HD Vec3 motion_of(const NearestSurface& at) const
    {
        if (is_mesh)
            return mesh.motion(at.feature, Vec3(1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0));
        return pose_t1 * (shape_from_t0 * at.point) - at.point;
    }
};

/// Advects a vertex with the surrounding surfaces, so that it stays on the correct side of a surface at t1.
struct AdvectVertex {
    View<const AdvectingCollider> colliders;
    View<const NearestSurface> nearest; ///< [vertices] at the end of the last step
    View<const Vec3> x;                 ///< [vertices] at t0 [m]
    double max_motion;                  ///< [m] maximum motion in the step of a surface that advects cloth
    View<Vec3> found_at;                ///< [vertices] out [m]

    TOILE_HD void operator()(int v) const
    {
        const Vec3 motion = advection(v);
        found_at[v] = motion.norm() <= max_motion ? Vec3(x[v] + motion) : x[v];
    }

    /// Displacement of the surface that was nearest [m]. Without one, the middle of the displacement bounds
    /// of the first moving mesh around the vertex.
    TOILE_HD Vec3 advection(int v) const
    {
        if (nearest[v].collider >= 0)
            return colliders[nearest[v].collider].motion_of(nearest[v]);
        for (int c = 0; c < colliders.size(); ++c)
            if (colliders[c].is_mesh && colliders[c].is_moving)
                if (const Bounds* const around = colliders[c].motion.around(x[v]))
                    return 0.5 * (around->lower + around->upper);
        return Vec3(0.0, 0.0, 0.0);
    }
};

/// Search radius of a vertex [m] at the start of a step.
struct ReachVertex {
    View<const Vec3> prediction, found_at; ///< [vertices] [m]
    double gap;                            ///< maximum contact thickness of any cloth [m]

    TOILE_HD double operator()(int v) const
    {
        const double whole = shape_reach(v);
        return whole < kMaxReach ? whole : kMaxReach;
    }

    /// The same of shapes, without a maximum: nothing else stops cloth at a plane.
    TOILE_HD double shape_reach(int v) const
    {
        return gap + kReachMargin + (prediction[v] - found_at[v]).norm();
    }
};

/// Marks a vertex that may be in contact with a mesh outside the region searched for it.
struct MarkUnseen {
    View<const double> clearance;      ///< [vertices] of x in front of the mesh [m]
    View<const Vec3> x, found_at;      ///< [vertices] [m]
    View<const double> reach;          ///< [vertices] search radius around found_at [m]
    double gap;                        ///< maximum contact thickness of any cloth [m]
    View<unsigned char> out_of_bounds; ///< [vertices] set to 1

    TOILE_HD bool is_unseen(int v) const
    {
        return clearance[v] < gap && (x[v] - found_at[v]).norm() > reach[v] - gap;
    }
    TOILE_HD void operator()(int v) const
    {
        if (is_unseen(v))
            out_of_bounds[v] = 1;
    }
};

} // namespace toile::collision
