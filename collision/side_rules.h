#pragma once

/// What a cloth vertex remembers of the sheets of moving meshes, and how. The same bodies on CPU and GPU.

#include <array>

#include "collision/collider_rules.h"

namespace toile {

/// A sheet is remembered once it is this near [m]. Parts that close faster than this in a step pass unseen.
inline constexpr double kSideReach = 0.02;

/// Deeper behind a sheet [m] than this it is forgotten: the walk along the surface has lost its place.
inline constexpr double kDeepestSide = 0.1;

/// A sheet that a vertex was in front of.
struct Side {
    int collider = -1; ///< -1: none
    int triangle = -1; ///< where the sheet was nearest
};

/// A vertex can be caught by no more: as many as planes in a corner.
inline constexpr int kMostSides = 3;
using VertexSides = std::array<Side, kMostSides>;

/// Calls visit(surface point) for the remembered sheets of a mesh at t1 that x is behind, but for those that
/// moved farther than `farthest` [m] in the step.
template <typename Visit>
TOILE_HD void visit_behind(const VertexSides& sides, const Vec3& x, const MeshPose& mesh, int collider,
                           double farthest, const Visit& visit)
{
    for (const Side& side : sides) {
        if (side.collider != collider ||
            mesh.motion(side.triangle, Vec3::Constant(1.0 / 3.0)).norm() > farthest)
            continue;
        const SurfacePoint at = mesh.surface.closest_from(x, side.triangle);
        if (at.signed_distance < 0.0 && at.distance() < kDeepestSide)
            visit(at);
    }
}

/// The sides of a vertex with those of one mesh renewed, as they are gathered.
struct LearntSides {
    int collider;
    VertexSides sides{};
    int count = 0;
    std::array<Vec3, kMostSides> normal{};

    TOILE_HD explicit LearntSides(int number) : collider(number) {}

    TOILE_HD bool is_wanted(const SurfacePoint& at) const
    {
        for (int k = 0; k < count; ++k)
            if (normal[k].dot(at.normal) > kDistinctCosine)
                return false;
        return count < kMostSides;
    }
    TOILE_HD void keep(const SurfacePoint& at)
    {
        if (!is_wanted(at))
            return;
        normal[count] = at.normal;
        sides[count++] = {collider, at.triangle};
    }

    /// First: what the vertex, which is at x, was in front of before, however it stands to it now. Returns a
    /// triangle that is probably near, or the hint.
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

    /// Last: those of other meshes.
    TOILE_HD void keep_those_of_others(const VertexSides& before)
    {
        for (const Side& side : before)
            if (side.collider >= 0 && side.collider != collider && count < kMostSides)
                sides[count++] = side;
    }
};

} // namespace toile
