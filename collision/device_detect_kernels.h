#pragma once

/// ContactDetector's search of one mesh: kernels. Every cloth vertex, vertex of the mesh and cloth edge is a
/// query with a few slots for what it finds; counts of queries are summed, which gives the pairs' places.

#include <cstdint>

#include "collision/side_rules.h"
#include "collision/surface_search.h"

namespace toile {

/// What the stages share.
struct DeviceSearch {
    View<const Vec3> x;       ///< [vertices] cloth positions [m]
    View<const double> reach; ///< [vertices] see ContactDetector::move; or empty
    SurfaceSearch mesh;       ///< what the cloth is near to
    View<const Vec3> mesh_x_t0;
    int collider = -1;                    ///< its number
    double radius = 0.0, max_depth = 0.0; ///< [m] see DetectSettings
    double farthest_motion = 0.0;         ///< [m]

    TOILE_HD MeshPose pose() const { return {mesh.surface, mesh_x_t0}; }

    /// Largest distance of a pair of these vertices [m].
    template <typename... Vertices>
    TOILE_HD double radius_of(Vertices... v) const
    {
        if (reach.empty())
            return radius;
        double most = -std::numeric_limits<double>::infinity();
        ((most = std::max(most, reach[v])), ...);
        return std::min(radius, most);
    }

    /// True when the cloth point c, which lies behind a feature with normal n at distance `most` or less, is
    /// inside the mesh there: not outside on the far side of a thin part, where pushing along n would pull
    /// the cloth through.
    TOILE_HD bool operator()(const Vec3& c, double most, const Vec3& n) const
    {
        const SurfacePoint nearest = mesh.closest(c, most * kReachSlack);
        return nearest.triangle >= 0 && is_below(nearest, n);
    }
};

/// What queries have found: item k of query i at k * queries + i.
struct Slots {
    View<int> items;
    int queries = 0;

    TOILE_HD int room() const { return queries > 0 ? items.size() / queries : 0; }
    TOILE_HD int& of(int i, int k) const { return items[k * queries + i]; }
};

/// Finds the planes of a cloth vertex.
struct FindPlanes {
    DeviceSearch search;
    View<const int> order;         ///< [vertices] neighbours side by side
    View<const VertexSides> sides; ///< [vertices] or empty: not known
    View<int> nearest;             ///< [vertices] in: triangle that is probably near, or -1; out
    Slots planes;                  ///< out: triangles
    View<int> counts;              ///< [vertices] out

    TOILE_HD void operator()(int i) const
    {
        const int v = order[i];
        counts[v] = 0;
        const Vec3& x = search.x[v];
        const double radius = search.radius_of(v);
        if (radius < 0.0)
            return;
        const SurfacePoint at = search.mesh.closest(x, std::max(radius, search.max_depth), nearest[v]);
        nearest[v] = at.triangle;
        if (at.triangle >= 0)
            counts[v] = find(v, x, radius, at);
    }

private:
    TOILE_HD int find(int v, const Vec3& x, double radius, const SurfacePoint& at) const
    {
        std::array<SurfacePoint, kMostSides> behind;
        int behind_count = 0;
        if (!sides.empty() && at.signed_distance < 0.0)
            visit_behind(sides[v], x, search.pose(), search.collider, search.farthest_motion,
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

/// Lists the sheets of cloth around a vertex of the mesh: triangles in which the distance is least.
struct FindSheets {
    DeviceSearch search;
    SurfaceSearch cloth; ///< its boxes grown by as much as pairs are wanted
    View<const std::array<int, 1>> vertices;
    View<const int> order; ///< [queries] places in vertices
    Slots sheets;          ///< out
    View<int> found;       ///< [vertices of the mesh] out: more than there is room for, too

    TOILE_HD void operator()(int i) const
    {
        const int v = vertices[order[i]][0];
        const Vec3& x = search.mesh.surface.positions[v];
        const NearPoint point = cloth.near(x);
        const BoxNode box = point.box_with(point, 0.0);
        const double most = kPiercedRadii * search.radius;
        int count = 0;
        cloth.visit_local_minima(
            x, Vec3::Zero(), [&](const BoxNode& node) { return node.box().overlaps(box.box()); },
            [&](const NearTriangle& near) { return near.closest.distance2 <= most * most; },
            [&](const NearTriangle& near) { list(v, cloth.surface.surface_point(near, x).triangle, count); });
        found[v] = count;
    }

private:
    TOILE_HD void list(int v, int triangle, int& count) const
    {
        const int kept = std::min(count, sheets.room());
        for (int k = 0; k < kept; ++k)
            if (sheets.of(v, k) == triangle)
                return;
        if (count < sheets.room())
            sheets.of(v, count) = triangle;
        ++count;
    }
};

/// The items of a query in ascending order.
TOILE_HD inline void sort_slots(const Slots& slots, int query, int count)
{
    for (int k = 1; k < count; ++k) {
        const int item = slots.of(query, k);
        int place = k;
        for (; place > 0 && slots.of(query, place - 1) > item; --place)
            slots.of(query, place) = slots.of(query, place - 1);
        slots.of(query, place) = item;
    }
}

/// Keeps the items for which is_kept(item, kept so far); returns their number.
template <typename IsKept>
TOILE_HD int keep_slots(const Slots& slots, int query, int count, const IsKept& is_kept)
{
    int kept = 0;
    for (int k = 0; k < count; ++k)
        if (const int item = slots.of(query, k); is_kept(item, kept))
            slots.of(query, kept++) = item;
    return kept;
}

/// Keeps the sheets that make pairs; of several at one point the lowest.
struct KeepSheets {
    DeviceSearch search;
    SurfaceView cloth;
    View<const int> found; ///< [vertices of the mesh]
    Slots sheets;          ///< in, out
    View<int> counts;      ///< [vertices of the mesh] out

    TOILE_HD void operator()(int v) const
    {
        int count = std::min(found[v], sheets.room());
        if (count > 0) {
            const Vec3& x = search.mesh.surface.positions[v];
            const Vec3 n = search.mesh.surface.vertex_normal(v);
            sort_slots(sheets, v, count);
            count = keep_slots(sheets, v, count, [&](int t, int kept) { return is_first(v, x, t, kept); });
            count = keep_slots(sheets, v, count, [&](int t, int) { return is_pair(x, n, t); });
        }
        counts[v] = count;
    }

private:
    TOILE_HD bool is_first(int v, const Vec3& x, int t, int kept) const
    {
        const Vec3 point = cloth.closest_on(t, x).point;
        for (int k = 0; k < kept; ++k)
            if ((cloth.closest_on(sheets.of(v, k), x).point - point).squaredNorm() < kSamePoint * kSamePoint)
                return false;
        return true;
    }
    TOILE_HD bool is_pair(const Vec3& x, const Vec3& n, int t) const
    {
        const Triangle& corner = cloth.triangles[t];
        return meets_sheet(x, n, cloth.surface_point({t, cloth.closest_on(t, x)}, x),
                           search.radius_of(corner[0], corner[1], corner[2]), search);
    }
};

/// Lists the ridges that a cloth edge crosses.
struct FindRidges {
    DeviceSearch search;
    View<const BoxNode> edges; ///< [queries] items of the cloth's tree: which edges, neighbours side by side
    View<const std::array<int, 2>> edge_vertex;
    Slots ridges;    ///< out
    View<int> found; ///< [cloth edges] out: more than there is room for, too

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
                                          if (count < ridges.room())
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

/// A cloth edge and a ridge that it crosses; false where they are no pair.
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
        const int listed = std::min(found[e], ridges.room());
        sort_slots(ridges, e, listed);
        counts[e] = keep_slots(ridges, e, listed, [&](int ridge, int) {
            ContactPair pair;
            return ridge_pair(search, edge_vertex[e], ridge, search, pair);
        });
    }
};

/// The largest of some counts, as a sum.
struct MostOf {
    View<const int> counts;

    TOILE_HD Largest operator()(int i) const { return {double(counts[i])}; }
};

} // namespace toile
