#pragma once

#include "collision/body/side_rules.h"
#include "collision/geometry/cuda/surface_search.h"

namespace toile::collision {

/// ContactSideHistory::update for a cloth vertex.
struct UpdateSides {
    View<const Vec3> x;                ///< [vertices] [m]
    SurfaceSearch mesh;                ///< at t1
    int collider;                      ///< its number
    View<const int> order;             ///< [vertices] neighbours adjacent
    View<const int> nearest;           ///< [vertices] triangle of the mesh that is probably near, or -1
    View<VertexSides> sides;           ///< [vertices] in, out
    View<const double> clearance = {}; ///< [vertices] see Clearance::of [m]; empty: unknown

    TOILE_HD void operator()(int i) const
    {
        const int v = order[i];
        const VertexSides before = sides[v];
        UpdatedSides updated(collider);
        const int hint = updated.keep_those_before(before, x[v], mesh.surface, nearest[v]);

        if (clearance.empty() || clearance[v] <= kSideReach)
            query(x[v], hint, updated);
        updated.keep_those_of_others(before);
        sides[v] = updated.sides;
    }

private:
    /// Adds the sheets that p is in front of at present.
    TOILE_HD void query(const Vec3& p, int hint, UpdatedSides& updated) const
    {
        const SurfacePoint at = mesh.closest(p, kSideReach, hint);
        if (at.triangle < 0 || at.signed_distance < 0.0)
            return;
        updated.keep(at);
        const auto is_wanted = [&](const SurfacePoint& sheet) {
            return sheet.signed_distance >= 0.0 && updated.is_wanted(sheet);
        };
        while (updated.count < kMaxSides) {
            const SurfacePoint sheet = mesh.next_sheet(p, kSideReach, at.normal, is_wanted);
            if (sheet.triangle < 0)
                break;
            updated.keep(sheet);
        }
    }
};

} // namespace toile::collision
