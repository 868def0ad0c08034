#pragma once

/// Rules of the sheets of moving meshes recorded for a cloth vertex. The same bodies run on CPU and GPU.

#include <array>

#include "collision/geometry/collider_rules.h"

namespace toile::collision {

/// Distance [m] within which a sheet is recorded. Parts that approach by more than this in a step are missed.
inline constexpr double kSideReach = 0.02;

/// Depth behind a sheet [m] beyond which it is dropped: the walk along the surface is no longer reliable.
inline constexpr double kDeepestSide = 0.1;

/// Sheet that a vertex was in front of.
struct Side {
    int collider = -1; ///< -1: none
    int triangle = -1; ///< triangle at which the sheet was nearest
};

/// Maximum number of sides of a vertex: as many as planes in a corner.
inline constexpr int kMaxSides = 3;
using VertexSides = std::array<Side, kMaxSides>;

/// Calls visit(surface point) for the recorded sheets of a mesh at t1 that x is behind. Skips sheets that
/// moved farther than `max_motion` [m] in the step.
template <typename Visit>
TOILE_HD void visit_behind(const VertexSides& sides, const Vec3& x, const MeshPose& mesh, int collider,
                           double max_motion, const Visit& visit)
{
    for (const Side& side : sides) {
        if (side.collider != collider ||
            mesh.motion(side.triangle, Vec3::Constant(1.0 / 3.0)).norm() > max_motion)
            continue;
        const SurfacePoint at = mesh.surface.closest_from(x, side.triangle);
        if (at.signed_distance < 0.0 && at.distance() < kDeepestSide)
            visit(at);
    }
}

/// Sides of a vertex under construction, with those of one mesh renewed.
struct UpdatedSides {
    int collider;
    VertexSides sides{};
    int count = 0;
    std::array<Vec3, kMaxSides> normal{};

    TOILE_HD explicit UpdatedSides(int number) : collider(number) {}

    TOILE_HD bool is_wanted(const SurfacePoint& at) const
    {
        for (int k = 0; k < count; ++k)
            if (normal[k].dot(at.normal) > kDistinctCosine)
                return false;
        return count < kMaxSides;
    }
    TOILE_HD void keep(const SurfacePoint& at)
    {
        if (!is_wanted(at))
            return;
        normal[count] = at.normal;
        sides[count++] = {collider, at.triangle};
    }

    /// First step: keeps recorded sheets of the mesh near the vertex at x, on whichever side it is now.
    /// Returns a triangle that is probably near, or the hint.
    TOILE_HD int keep_those_before(const VertexSides& before, const Vec3& x, const SurfaceView& mesh,
                                   int hint)
    {
        for (const Side& side : before) {
            if (side.collider != collider)
                continue;
            const SurfacePoint at = mesh.closest_from(x, side.triangle);
            hint = at.triangle;
            if (at.distance() < (at.signed_distance < 0.0 ? kDeepestSide : kSideReach))
                keep(at);
        }
        return hint;
    }

    /// Last step: keeps the sides of other meshes.
    TOILE_HD void keep_those_of_others(const VertexSides& before)
    {
        for (const Side& side : before)
            if (side.collider >= 0 && side.collider != collider && count < kMaxSides)
                sides[count++] = side;
    }
};

} // namespace toile::collision
