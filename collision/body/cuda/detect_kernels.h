#pragma once

/// Kernels of ContactDetector's search of one mesh. Every cloth vertex, triangle and edge is a query with a
/// few slots for its results. Prefix sums of the queries' counts give the indices of the pairs.

#include <cstdint>

#include "collision/body/side_rules.h"
#include "collision/geometry/cuda/surface_search.h"

namespace toile::collision {

/// Inputs shared by the stages.
struct DeviceSearch {
    View<const Vec3> x;       ///< [vertices] cloth positions [m]
    View<const double> reach; ///< [vertices] see ContactDetector::move; or empty
    SurfaceSearch mesh;       ///< collider near the cloth
    View<const Vec3> mesh_x_t0;
    int collider = -1;                    ///< its number
    double radius = 0.0, max_depth = 0.0; ///< [m] see DetectSettings
    double max_motion = 0.0;              ///< [m]

    TOILE_HD MeshPose pose() const { return {mesh.surface, mesh_x_t0}; }

    /// Largest distance of a pair of these vertices [m].
    template <typename... Vertices>
    TOILE_HD double radius_of(Vertices... v) const
    {
        if (reach.empty())
            return radius;
        double max_reach = -std::numeric_limits<double>::infinity();
        ((max_reach = std::max(max_reach, reach[v])), ...);
        return std::min(radius, max_reach);
    }

    /// True if the cloth point c is inside the mesh, below a feature with normal n at distance `max_distance`
    /// or less. False on the far side of a thin part, where a push along n would pull the cloth through.
    TOILE_HD bool operator()(const Vec3& c, double max_distance, const Vec3& n) const
    {
        const SurfacePoint nearest = mesh.closest(c, max_distance * kReachSlack);
        return nearest.triangle >= 0 && is_below(nearest, n);
    }
};

/// Results of queries: item k of query i is at k * queries + i.
struct Slots {
    View<int> items;
    int queries = 0;

    TOILE_HD int capacity() const { return queries > 0 ? items.size() / queries : 0; }
    TOILE_HD int& of(int i, int k) const { return items[k * queries + i]; }
};

/// Finds the planes of a cloth vertex.
struct FindPlanes {
    DeviceSearch search;
    View<const int> order;             ///< [vertices] neighbours adjacent
    View<const VertexSides> sides;     ///< [vertices] or empty: unknown
    View<int> nearest;                 ///< [vertices] in: triangle that is probably near, or -1; out: nearest
    Slots planes;                      ///< out: triangles
    View<int> counts;                  ///< [vertices] out
    View<double> in_front;             ///< [vertices] out: see Clearance::record [m]; negative: not searched
    View<const double> clearance = {}; ///< [vertices] see Clearance::of [m]; empty: unknown

    TOILE_HD void operator()(int i) const
    {
        const int v = order[i];
        counts[v] = 0;
        in_front[v] = -1.0;
        const Vec3& x = search.x[v];
        const double radius = search.radius_of(v);
        if (radius < 0.0 || (!clearance.empty() && clearance[v] > radius))
            return;
        const double reach = std::max(radius, search.max_depth);
        const SurfacePoint at = search.mesh.closest(x, reach, nearest[v]);
        nearest[v] = at.triangle;
        in_front[v] = at.triangle >= 0 ? std::max(at.signed_distance, 0.0) : reach;
        if (at.triangle >= 0)
            counts[v] = find(v, x, radius, at);
    }

private:
    TOILE_HD int find(int v, const Vec3& x, double radius, const SurfacePoint& at) const
    {
        std::array<SurfacePoint, kMaxSides> behind;
        int behind_count = 0;
        if (!sides.empty() && at.signed_distance < 0.0)
            visit_behind(sides[v], x, search.pose(), search.collider, search.max_motion,
                         [&](const SurfacePoint& sheet) { behind[behind_count++] = sheet; });

        VertexPlanes chosen(x, radius, search.max_depth);
        const auto add = [&](const SurfacePoint& sheet) { planes.of(v, chosen.count - 1) = sheet.triangle; };
        chosen.take_first(at, {behind.data(), behind_count}, add);
        while (chosen.count > 0 && !chosen.is_full()) {
            const SurfacePoint sheet =
                search.mesh.next_sheet(x, radius, chosen.normal[0],
                                       [&](const SurfacePoint& other) { return chosen.is_wanted(other); });
            if (sheet.triangle < 0)
                break;
            chosen.take(sheet, add);
        }
        return chosen.count;
    }
};

/// Lists the mesh vertices for which a cloth triangle is a sheet: it contains a local minimum of the distance
/// and is the lowest triangle at the closest point.
struct FindSheets {
    DeviceSearch search;
    SurfaceView cloth;
    View<const BoxNode> triangles; ///< [queries] items of the cloth's tree: neighbours adjacent
    Slots sheets;                  ///< out: vertices of the mesh
    View<int> found;               ///< [cloth triangles] out: count, which may exceed the capacity

    TOILE_HD void operator()(int i) const
    {
        const int t = triangles[i].last;
        const Triangle& corner = cloth.triangles[t];
        const double reach = kMaxPenetrationRadii * search.radius_of(corner[0], corner[1], corner[2]);
        int count = 0;
        if (reach >= 0.0) {
            const SurfaceSearch& mesh = search.mesh;
            const NearPoint c = mesh.near(search.x[corner[2]]);
            BoxNode box = mesh.near(search.x[corner[0]]).box_with(mesh.near(search.x[corner[1]]), reach);
            box.add(c.box_with(c, reach));
            mesh.triangles.descend([&](const BoxNode& node) { return node.box().overlaps(box.box()); },
                                   [&](int triangle) { list(t, reach, triangle, count); });
        }
        found[t] = count;
    }

private:
    /// Appends the mesh vertices owned by a mesh triangle; a vertex belongs to the first of its triangles.
    TOILE_HD void list(int t, double reach, int triangle, int& count) const
    {
        const SurfaceView& mesh = search.mesh.surface;
        for (int k = 0; k < 3; ++k) {
            const int v = mesh.triangles[triangle][k];
            if (mesh.edges.corners_of_vertex.of(v)[0] != 3 * triangle + k || !is_sheet(t, reach, v))
                continue;
            if (count < sheets.capacity())
                sheets.of(t, count) = v;
            ++count;
        }
    }
    TOILE_HD bool is_sheet(int t, double reach, int v) const
    {
        const Vec3& x = search.mesh.surface.positions[v];
        const NearTriangle near{t, cloth.closest_on(t, x)};
        return near.closest.distance2 <= reach * reach && cloth.is_local_minimum(near, x) &&
               cloth.lowest_at(near, x).triangle == t;
    }
};

/// Sorts the items of a query in ascending order.
TOILE_HD inline void sort_slots(const Slots& slots, int query, int count)
{
    for (int k = 1; k < count; ++k) {
        const int item = slots.of(query, k);
        int slot = k;
        for (; slot > 0 && slots.of(query, slot - 1) > item; --slot)
            slots.of(query, slot) = slots.of(query, slot - 1);
        slots.of(query, slot) = item;
    }
}

/// Lists the ridges that a cloth edge crosses.
struct FindRidges {
    DeviceSearch search;
    View<const BoxNode> edges; ///< [queries] items of the cloth's tree: edges, neighbours adjacent
    View<const std::array<int, 2>> edge_vertex;
    Slots ridges;    ///< out
    View<int> found; ///< [cloth edges] out: count, which may exceed the capacity

    TOILE_HD void operator()(int i) const
    {
        const int e = edges[i].last;
        const std::array<int, 2> end = edge_vertex[e];
        const double radius = search.radius_of(end[0], end[1]);
        int count = 0;
        if (radius >= 0.0) {
            const Vec3 &a = search.x[end[0]], &b = search.x[end[1]];
            const BoxNode box = search.mesh.near(a).box_with(search.mesh.near(b), radius);
            search.mesh.edges.descend([&](const BoxNode& node) { return node.box().overlaps(box.box()); },
                                      [&](int ridge) {
                                          if (!is_crossed(a, b, ridge, radius))
                                              return;
                                          if (count < ridges.capacity())
                                              ridges.of(e, count) = ridge;
                                          ++count;
                                      });
        }
        found[e] = count;
    }

private:
    TOILE_HD bool is_crossed(const Vec3& a, const Vec3& b, int ridge, double radius) const
    {
        const SurfaceView& mesh = search.mesh.surface;
        const std::array<int, 2>& v = mesh.edges.vertex[ridge];
        const ClosestOnSegments closest = crossing(a, b, mesh.positions[v[0]], mesh.positions[v[1]]);
        return closest.s >= 0.0 && closest.distance2 < radius * radius && mesh.is_ridge(ridge);
    }
};

/// Forms the pair of a cloth edge and a ridge that it crosses; false if they are no pair.
template <typename IsInsideBelow>
TOILE_HD bool ridge_pair(const DeviceSearch& search, const std::array<int, 2>& end, int ridge,
                         const IsInsideBelow& is_inside_below, ContactPair& pair)
{
    const SurfaceView& mesh = search.mesh.surface;
    const Vec3 &a = search.x[end[0]], &b = search.x[end[1]];
    const std::array<int, 2>& v = mesh.edges.vertex[ridge];
    return meets_ridge(search.pose(), search.collider, end, a, b, ridge,
                       crossing(a, b, mesh.positions[v[0]], mesh.positions[v[1]]), is_inside_below, pair);
}

/// Keeps the ridges that make pairs, by number.
struct KeepRidges {
    DeviceSearch search;
    View<const std::array<int, 2>> edge_vertex;
    View<const int> found; ///< [cloth edges]
    Slots ridges;          ///< in, out
    View<int> counts;      ///< [cloth edges] out

    TOILE_HD void operator()(int e) const
    {
        const int listed = std::min(found[e], ridges.capacity());
        sort_slots(ridges, e, listed);
        int kept = 0;
        ContactPair pair;
        for (int k = 0; k < listed; ++k)
            if (const int ridge = ridges.of(e, k); ridge_pair(search, edge_vertex[e], ridge, search, pair))
                ridges.of(e, kept++) = ridge;
        counts[e] = kept;
    }
};

/// Maximum of some counts, as a sum.
struct MaxOf {
    View<const int> counts;

    TOILE_HD Largest operator()(int i) const { return {double(counts[i])}; }
};

} // namespace toile::collision
