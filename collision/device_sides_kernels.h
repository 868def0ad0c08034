#pragma once

#include "collision/side_rules.h"
#include "collision/surface_search.h"

namespace toile {

/// SideMemory::learn of a cloth vertex.
struct LearnSides {
    View<const Vec3> x;                ///< [vertices] [m]
    SurfaceSearch mesh;                ///< at t1
    int collider;                      ///< its number
    View<const int> order;             ///< [vertices] neighbours side by side
    View<const int> nearest;           ///< [vertices] a triangle of the mesh that is probably near, or -1
    View<VertexSides> sides;           ///< [vertices] in, out
    View<const double> clearance = {}; ///< [vertices] see Clearance::of [m]; empty: not known

    TOILE_HD void operator()(int i) const
    {
        const int v = order[i];
        const VertexSides before = sides[v];
        LearntSides learnt(collider);
        const int hint = learnt.keep_those_before(before, x[v], mesh.surface, nearest[v]);

        if (clearance.empty() || clearance[v] <= kSideReach)
            look(x[v], hint, learnt);
        learnt.keep_those_of_others(before);
        sides[v] = learnt.sides;
    }

private:
    /// Learns what p is in front of now.
    TOILE_HD void look(const Vec3& p, int hint, LearntSides& learnt) const
    {
        const SurfacePoint at = mesh.closest(p, kSideReach, hint);
        if (at.triangle < 0 || at.signed_distance < 0.0)
            return;
        learnt.keep(at);
        const auto is_wanted = [&](const SurfacePoint& sheet) {
            return sheet.signed_distance >= 0.0 && learnt.is_wanted(sheet);
        };
        while (learnt.count < kMostSides) {
            const SurfacePoint sheet = mesh.next_sheet(p, kSideReach, at.normal, is_wanted);
            if (sheet.triangle < 0)
                break;
            learnt.keep(sheet);
        }
    }
};

} // namespace toile
