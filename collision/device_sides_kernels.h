#pragma once

#include "collision/side_rules.h"
#include "collision/surface_search.h"

namespace toile {

/// SideMemory::learn of a cloth vertex.
struct LearnSides {
    View<const Vec3> x;      ///< [vertices] [m]
    SurfaceSearch mesh;      ///< at t1
    int collider;            ///< its number
    View<const int> order;   ///< [vertices] neighbours side by side
    View<const int> nearest; ///< [vertices] a triangle of the mesh that is probably near, or -1
    View<VertexSides> sides; ///< [vertices] in, out

    TOILE_HD void operator()(int i) const
    {
        const int v = order[i];
        const VertexSides before = sides[v];
        LearntSides learnt(collider);
        const int hint = learnt.keep_those_before(before, x[v], mesh.surface, nearest[v]);

        // What it is in front of now.
        const SurfacePoint at = mesh.closest(x[v], kSideReach, hint);
        if (at.triangle >= 0 && at.signed_distance >= 0.0) {
            learnt.keep(at);
            const auto is_wanted = [&](const SurfacePoint& sheet) {
                return sheet.signed_distance >= 0.0 && learnt.is_wanted(sheet);
            };
            while (learnt.count < kMostSides) {
                const SurfacePoint sheet = mesh.next_sheet(x[v], kSideReach, at.normal, is_wanted);
                if (sheet.triangle < 0)
                    break;
                learnt.keep(sheet);
            }
        }
        learnt.keep_those_of_others(before);
        sides[v] = learnt.sides;
    }
};

} // namespace toile
