#include "collision/side_memory.h"

#include <algorithm>

#include "collision/find_pairs.h"
#include "core/backend/parallel.h"

namespace toile {

void SideMemory::learn(View<const Vec3> x, const MeshCollider& mesh, int collider, const Clearance& clearance)
{
    if (mesh.move_count() == 0)
        return;
    parallel_for(kCpu, "collision/learn_sides", x.size(), [&](int v) {
        const bool is_known = std::any_of(sides_[v].begin(), sides_[v].end(),
                                          [&](const Side& side) { return side.collider == collider; });
        if (is_known || (clearance.of(v) <= kSideReach && is_near(mesh.bounds(), x[v], kSideReach)))
            sides_[v] = learnt(v, x[v], mesh, collider, clearance.nearest(v));
    });
}

/// The sides of a vertex with those of one mesh renewed.
/// @param hint  see SurfaceProximity::closest
VertexSides SideMemory::learnt(int v, const Vec3& x, const MeshCollider& mesh, int collider, int hint) const
{
    LearntSides learnt(collider);
    hint = learnt.keep_those_before(sides_[v], x, mesh.surface().view(), hint);

    // What it is in front of now.
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(x, kSideReach, hint);
    if (nearest && nearest->signed_distance >= 0.0) {
        learnt.keep(*nearest);
        thread_local std::vector<SurfacePoint> sheets;
        mesh.surface().local_closest(x, kSideReach, sheets, nearest->normal);
        for (const SurfacePoint& sheet : sheets)
            if (sheet.signed_distance >= 0.0)
                learnt.keep(sheet);
    }
    learnt.keep_those_of_others(sides_[v]);
    return learnt.sides;
}

void SideMemory::find_behind(int v, const Vec3& x, const MeshCollider& mesh, int collider, double farthest,
                             std::vector<SurfacePoint>& out) const
{
    out.clear();
    visit_behind(sides_[v], x, mesh.pose(), collider, farthest,
                 [&](const SurfacePoint& at) { out.push_back(at); });
}

} // namespace toile
