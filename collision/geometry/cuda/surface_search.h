#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/geometry/cuda/surface_kernels.h"
#include "collision/geometry/surface_view.h"

namespace toile::collision {

/// Point in single precision relative to the middle of the surface, as the boxes of a tree are.
struct NearPoint {
    std::array<float, 3> x{}; ///< [m]
    double largest = 0.0;     ///< [m] largest coordinate

    TOILE_HD NearPoint(const Vec3& p, const Vec3& middle)
    {
        const Vec3 from = p - middle;
        for (int k = 0; k < 3; ++k)
            x[k] = float(from[k]);
        largest = from.cwiseAbs().maxCoeff();
    }

    /// Search radius [m] that covers in single precision everything within `radius` in exact arithmetic. The
    /// boxes are already grown by their own rounding.
    TOILE_HD double padded(double radius) const { return radius + kFloatSlack * (radius + largest); }
    /// Square of the padded radius [m^2]; finite, so that empty boxes lie outside.
    TOILE_HD float squared(double radius) const
    {
        const double all = padded(radius);
        return float(std::min(all * all, 0.5 * double(std::numeric_limits<float>::max())));
    }
    /// Squared distance to a box [m^2].
    TOILE_HD float distance2(const BoxNode& box) const
    {
        float sum = 0.0f;
        for (int k = 0; k < 3; ++k) {
            const float outside = std::max(std::max(box.lower[k] - x[k], x[k] - box.upper[k]), 0.0f);
            sum += outside * outside;
        }
        return sum;
    }
    /// Box around everything within `radius` [m] of this point and another.
    TOILE_HD BoxNode box_with(const NearPoint& other, double radius) const
    {
        const float grow = float(std::max(padded(radius), other.padded(radius)));
        BoxNode box;
        for (int k = 0; k < 3; ++k) {
            box.lower[k] = std::min(x[k], other.x[k]) - grow;
            box.upper[k] = std::max(x[k], other.x[k]) + grow;
        }
        return box;
    }
};

/// Proximity queries on a surface on a GPU, with the same results as SurfaceProximity on the CPU.
struct SurfaceSearch {
    SurfaceView surface;
    ImplicitBoxTree triangles, edges; ///< at the surface's positions
    View<const SoupExtent> extent;    ///< [1] of the positions

    TOILE_HD NearPoint near(const Vec3& p) const { return {p, 0.5 * (extent[0].lower + extent[0].upper)}; }

    /// SurfaceProximity::closest; triangle -1 means none.
    TOILE_HD SurfacePoint closest(const Vec3& p, double max_distance, int hint = -1) const
    {
        NearTriangle best;
        best.closest.distance2 = max_distance * max_distance;
        const NearPoint center = near(p);
        float radius2 = center.squared(max_distance);
        const auto try_triangle = [&](int t) {
            const NearTriangle other{t, surface.closest_on(t, p)};
            const double distance2 = other.closest.distance2;
            if (distance2 < best.closest.distance2 ||
                (distance2 == best.closest.distance2 && best.triangle >= 0 && t < best.triangle)) {
                best = other;
                radius2 = center.squared(std::sqrt(distance2));
            }
        };

        // A first guess shrinks the sphere before the descent.
        const auto distance2_of = [&](const BoxNode& box) { return center.distance2(box); };
        const int first = hint >= 0 ? hint : triangles.greedy_item(distance2_of);
        if (first >= 0)
            try_triangle(first);
        triangles.descend([&](const BoxNode& box) { return center.distance2(box) <= radius2; }, try_triangle);
        return best.triangle < 0 ? SurfacePoint() : surface.surface_point(best, p);
    }

    /// First result of SurfaceProximity::local_closest with is_wanted(surface point); triangle -1 means none.
    template <typename IsWanted>
    TOILE_HD SurfacePoint next_sheet(const Vec3& p, double radius, const Vec3& unlike,
                                     const IsWanted& is_wanted) const
    {
        SurfacePoint best;
        double reach = radius;
        const NearPoint center = near(p);
        float radius2 = center.squared(radius);
        visit_local_minima(
            p, unlike, [&](const BoxNode& box) { return center.distance2(box) <= radius2; },
            [&](const NearTriangle& other) { return other.closest.distance2 <= reach * reach; },
            [&](const NearTriangle& other) {
                const SurfacePoint at = surface.surface_point(other, p);
                if (!is_wanted(at) || (best.triangle >= 0 && !is_before(at, best)))
                    return;
                best = at;
                reach = std::min(radius, at.distance() + kSamePoint);
                radius2 = center.squared(reach);
            });
        return best;
    }

    /// Calls visit(near triangle) for local minima of the distance, at least once for each.
    /// @param is_open  (box) false if nothing below is wanted
    /// @param is_near  (near triangle) false if unwanted; tested before the more expensive conditions
    /// @param unlike   see SurfaceProximity::local_closest
    template <typename IsOpen, typename IsNear, typename Visit>
    TOILE_HD void visit_local_minima(const Vec3& p, const Vec3& unlike, const IsOpen& is_open,
                                     const IsNear& is_near, const Visit& visit) const
    {
        triangles.descend(is_open, [&](int t) {
            const NearTriangle other{t, surface.closest_on(t, p)};
            if (is_near(other) && surface.face_normal(t).dot(unlike) <= kUnlikeCosine &&
                surface.is_local_minimum(other, p))
                visit(other);
        });
    }

private:
    /// Order of SurfaceProximity::local_closest, in which coincident points are represented by the lowest
    /// triangle.
    TOILE_HD static bool is_before(const SurfacePoint& a, const SurfacePoint& b)
    {
        if (a.is_at(b.point))
            return a.triangle < b.triangle;
        return a.distance() < b.distance() || (a.distance() == b.distance() && a.triangle < b.triangle);
    }
};

} // namespace toile::collision
