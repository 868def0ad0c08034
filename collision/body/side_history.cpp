#include "collision/body/side_history.h"

#include <algorithm>

#include "collision/body/find_pairs.h"
#include "core/compute/parallel.h"

namespace toile::collision {

void ContactSideHistory::update(View<const Vec3> x, const MeshCollider& mesh, int collider,
                                const Clearance& clearance)
{
    if (mesh.move_count() == 0)
        return;
    parallel_for(kCpu, "collision/update_sides", x.size(), [&](int v) {
        const bool is_known = std::any_of(sides_[v].begin(), sides_[v].end(),
                                          [&](const Side& side) { return side.collider == collider; });
        if (is_known || (clearance.of(v) <= kSideReach && is_near(mesh.bounds(), x[v], kSideReach)))
            sides_[v] = updated_sides(v, x[v], mesh, collider, clearance.nearest(v));
    });
}

/// Sides of a vertex, with those of one mesh renewed.
/// @param hint  see SurfaceProximity::closest
VertexSides ContactSideHistory::updated_sides(int v, const Vec3& x, const MeshCollider& mesh, int collider,
                                              int hint) const
{
    UpdatedSides updated(collider);
    hint = updated.keep_those_before(sides_[v], x, mesh.surface().view(), hint);

    // Add the sheets that the vertex is in front of at present.
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(x, kSideReach, hint);
    if (nearest && nearest->signed_distance >= 0.0) {
        updated.keep(*nearest);
        thread_local std::vector<SurfacePoint> sheets;
        mesh.surface().local_closest(x, kSideReach, sheets, nearest->normal);
        for (const SurfacePoint& sheet : sheets)
            if (sheet.signed_distance >= 0.0)
                updated.keep(sheet);
    }
    updated.keep_those_of_others(sides_[v]);
    return updated.sides;
}

void ContactSideHistory::find_behind(int v, const Vec3& x, const MeshCollider& mesh, int collider,
                                     double max_motion, std::vector<SurfacePoint>& out) const
{
    out.clear();
    visit_behind(sides_[v], x, mesh.pose(), collider, max_motion,
                 [&](const SurfacePoint& at) { out.push_back(at); });
}

} // namespace toile::collision
