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
        if (is_known || (clearance.of(v) <= kReach && is_near(mesh.bounds(), x[v], kReach)))
            sides_[v] = learnt(v, x[v], mesh, collider, clearance.nearest(v));
    });
}

/// The sides of a vertex with those of one mesh renewed.
/// @param hint  see SurfaceProximity::closest
SideMemory::Sides SideMemory::learnt(int v, const Vec3& x, const MeshCollider& mesh, int collider,
                                     int hint) const
{
    Sides sides;
    int count = 0;
    std::array<Vec3, kMostSides> normals;
    const auto keep = [&](const SurfacePoint& at) {
        const bool is_known = std::any_of(normals.begin(), normals.begin() + count,
                                          [&](const Vec3& n) { return n.dot(at.normal) > kDistinctCosine; });
        if (count == kMostSides || is_known)
            return;
        normals[size_t(count)] = at.normal;
        sides[size_t(count++)] = {collider, at.triangle};
    };

    // What it was in front of before, however it stands to it now.
    for (const Side& side : sides_[v]) {
        if (side.collider != collider)
            continue;
        const SurfacePoint at = mesh.surface().closest_from(x, side.triangle);
        hint = at.triangle;
        if (at.distance() < (at.signed_distance < 0.0 ? kDeepest : kReach))
            keep(at);
    }

    // What it is in front of now.
    const std::optional<SurfacePoint> nearest = mesh.surface().closest(x, kReach, hint);
    if (nearest && nearest->signed_distance >= 0.0) {
        keep(*nearest);
        thread_local std::vector<SurfacePoint> sheets;
        mesh.surface().local_closest(x, kReach, sheets, nearest->normal);
        for (const SurfacePoint& sheet : sheets)
            if (sheet.signed_distance >= 0.0)
                keep(sheet);
    }

    for (const Side& side : sides_[v])
        if (side.collider >= 0 && side.collider != collider && count < kMostSides)
            sides[size_t(count++)] = side;
    return sides;
}

void SideMemory::find_behind(int v, const Vec3& x, const MeshCollider& mesh, int collider, double farthest,
                             std::vector<SurfacePoint>& out) const
{
    out.clear();
    for (const Side& side : sides_[v]) {
        if (side.collider != collider ||
            mesh.motion(side.triangle, Vec3::Constant(1.0 / 3.0)).norm() > farthest)
            continue;
        const SurfacePoint at = mesh.surface().closest_from(x, side.triangle);
        if (at.signed_distance < 0.0 && at.distance() < kDeepest)
            out.push_back(at);
    }
}

} // namespace toile
