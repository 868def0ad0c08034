#pragma once

/// What ColliderPairs asks of every cloth vertex. The same bodies on CPU and GPU.

#include <limits>

#include <Eigen/Geometry>

#include "collision/contact_pair.h"
#include "collision/motion_bounds.h"
#include "collision/surface_view.h"

namespace toile {

/// Largest distance [m] looked at. Cloth that moves further relative to a collider in one step may pass it.
inline constexpr double kMaxReach = 0.06;

/// How far [m] the solver may take cloth from where it was expected before more pairs are looked for.
inline constexpr double kReachMargin = 0.003;

/// The reach of vertices whose pairs are kept.
inline constexpr double kNowhere = -std::numeric_limits<double>::infinity();

/// The surface point nearest to a cloth vertex.
struct NearestSurface {
    int collider = -1; ///< -1: none near
    int feature = -1;
    double gap = 0.0;          ///< [m]
    Vec3 point = Vec3::Zero(); ///< [m]

    /// Takes over a pair of the vertex that is nearer.
    /// @param x  [vertices] where it was found [m]
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

/// A ContactPartner as what takes cloth along.
struct CarryingPartner {
    bool is_mesh = false;
    bool is_moving = false;                   ///< of a mesh: in this step
    MeshPose mesh;                            ///< of a mesh
    MotionView motion;                        ///< likewise, in its last move
    Eigen::Isometry3d pose_t1, shape_from_t0; ///< of a shape: world_from_shape at t1, and its inverse at t0

    /// Displacement in the step [m] of a point of its surface.
    TOILE_HD Vec3 motion_of(const NearestSurface& at) const
    {
        if (is_mesh)
            return mesh.motion(at.feature, Vec3(1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0));
        return pose_t1 * (shape_from_t0 * at.point) - at.point;
    }
};

/// Moves a vertex along with what is around it, so that it is still on the right side of a surface at t1.
struct CarryVertex {
    View<const CarryingPartner> partners;
    View<const NearestSurface> nearest; ///< [vertices] at the end of the last step
    View<const Vec3> x;                 ///< [vertices] at t0 [m]
    double farthest_motion;             ///< [m] in the step, of a surface that takes cloth along
    View<Vec3> found_at;                ///< [vertices] out [m]

    TOILE_HD void operator()(int v) const
    {
        const Vec3 motion = carrying_motion(v);
        found_at[v] = motion.norm() <= farthest_motion ? Vec3(x[v] + motion) : x[v];
    }

    /// That of the surface that was nearest [m]; where none was near, the middle of those of meshes around.
    TOILE_HD Vec3 carrying_motion(int v) const
    {
        if (nearest[v].collider >= 0)
            return partners[nearest[v].collider].motion_of(nearest[v]);
        for (int c = 0; c < partners.size(); ++c)
            if (partners[c].is_mesh && partners[c].is_moving)
                if (const Bounds* const around = partners[c].motion.around(x[v]))
                    return 0.5 * (around->lower + around->upper);
        return Vec3(0.0, 0.0, 0.0);
    }
};

/// How far a vertex is to be looked around [m], at the start of a step.
struct ReachVertex {
    View<const Vec3> prediction, found_at; ///< [vertices] [m]
    double gap;                            ///< the largest that any cloth is to keep [m]

    TOILE_HD double operator()(int v) const
    {
        const double reach = gap + kReachMargin + (prediction[v] - found_at[v]).norm();
        return reach < kMaxReach ? reach : kMaxReach;
    }
};

/// Marks a vertex that may touch a mesh where nobody has looked.
struct MarkUnseen {
    View<const double> clearance; ///< [vertices] of x in front of the mesh [m]
    View<const Vec3> x, found_at; ///< [vertices] [m]
    View<const double> reach;     ///< [vertices] how near to found_at was looked [m]
    double gap;                   ///< the largest that any cloth is to keep [m]
    View<unsigned char> strays;   ///< [vertices] set to 1

    TOILE_HD bool is_unseen(int v) const
    {
        return clearance[v] < gap && (x[v] - found_at[v]).norm() > reach[v] - gap;
    }
    TOILE_HD void operator()(int v) const
    {
        if (is_unseen(v))
            strays[v] = 1;
    }
};

} // namespace toile
