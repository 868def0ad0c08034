#pragma once

/// Kernels that write the results of ContactDetector's search of one mesh as pairs, in their order.

#include "collision/body/cuda/detect_kernels.h"

namespace toile::collision {

/// Indices of the pairs of the three kinds: item i of a kind has its pairs from first[begin + i] on.
struct PairSlots {
    View<const long> first; ///< [vertices + sheet capacity + cloth edges + 1]
    int vertices = 0, sheet_capacity = 0;

    TOILE_HD long of_vertex(int v) const { return first[v]; }
    TOILE_HD long of_edge(int e) const { return first[vertices + sheet_capacity + e]; }
    TOILE_HD long all() const { return first[first.size() - 1]; }
    TOILE_HD long first_sheet() const { return first[vertices]; }
    TOILE_HD long sheets() const { return first[vertices + sheet_capacity] - first_sheet(); }
};

/// Writes the pairs of cloth vertex v.
struct ReportPlanes {
    DeviceSearch search;
    View<const int> counts; ///< [vertices]
    Slots planes;
    PairSlots pair_slots;
    View<ContactPair> pairs; ///< out, up to its capacity

    TOILE_HD void operator()(int v) const
    {
        const Vec3& x = search.x[v];
        const SurfaceView& mesh = search.mesh.surface;
        const long first = pair_slots.of_vertex(v);
        for (int k = 0; k < counts[v] && first + k < pairs.size(); ++k) {
            const int t = planes.of(v, k);
            pairs[int(first + k)] = vertex_face_pair(search.pose(), search.collider, v, x,
                                                     mesh.surface_point({t, mesh.closest_on(t, x)}, x));
        }
    }
};

/// Key of unused capacity, above the keys of all sheets.
inline constexpr std::uint64_t kNoSheet = ~std::uint64_t(0);

struct ClearSheetKeys {
    View<std::uint64_t> keys; ///< out
    View<int> slots;          ///< out

    TOILE_HD void operator()(int i) const
    {
        keys[i] = kNoSheet;
        slots[i] = -1;
    }
};

/// Writes the keys of the sheet candidates of cloth triangle t: by mesh vertex, then by triangle.
struct KeySheets {
    View<const long> first; ///< [cloth triangles + 1] prefix sums of the counts
    Slots sheets;
    View<std::uint64_t> keys; ///< out, up to its capacity
    View<int> slots;          ///< out: index into the slots' items

    TOILE_HD void operator()(int t) const
    {
        const int count = std::min(int(first[t + 1] - first[t]), sheets.capacity());
        for (int k = 0; k < count && first[t] + k < keys.size(); ++k) {
            const int slot = int(first[t] + k);
            keys[slot] = std::uint64_t(sheets.of(t, k)) * sheets.queries + t;
            slots[slot] = k * sheets.queries + t;
        }
    }
};

/// Keeps sheet i if it forms a pair; of coincident sheets it keeps the lowest. Writes the keys of pairs: by
/// corners of the cloth triangle, then by mesh vertex.
struct KeepSheets {
    DeviceSearch search;
    SurfaceView cloth;
    Slots sheets;
    View<const int> sorted;   ///< [capacity] slots by mesh vertex, then by triangle
    View<const int> rank;     ///< [cloth triangles] rank in the order of their corners
    View<int> counts;         ///< [capacity] out: 0 or 1
    View<std::uint64_t> keys; ///< [capacity] out
    View<int> slots;          ///< [capacity] out

    TOILE_HD void operator()(int i) const
    {
        const bool is_kept = sorted[i] >= 0 && is_first(i) && is_pair(i);
        counts[i] = int(is_kept);
        keys[i] = is_kept
                      ? std::uint64_t(rank[triangle(i)]) * search.mesh.surface.positions.size() + vertex(i)
                      : kNoSheet;
        slots[i] = sorted[i];
    }

private:
    TOILE_HD int vertex(int i) const { return sheets.items[sorted[i]]; }
    TOILE_HD int triangle(int i) const { return sorted[i] % sheets.queries; }
    TOILE_HD Vec3 point(int i, const Vec3& x) const { return cloth.closest_on(triangle(i), x).point; }

    TOILE_HD bool is_first(int i) const
    {
        const int v = vertex(i);
        const Vec3& x = search.mesh.surface.positions[v];
        const Vec3 closest = point(i, x);
        for (int k = i - 1; k >= 0 && vertex(k) == v; --k)
            if ((point(k, x) - closest).squaredNorm() < kSamePoint * kSamePoint)
                return false;
        return true;
    }
    TOILE_HD bool is_pair(int i) const
    {
        const SurfaceView& mesh = search.mesh.surface;
        const int v = vertex(i), t = triangle(i);
        const Vec3& x = mesh.positions[v];
        const Triangle& corner = cloth.triangles[t];
        return meets_sheet(x, mesh.vertex_normal(v), cloth.surface_point({t, cloth.closest_on(t, x)}, x),
                           search.radius_of(corner[0], corner[1], corner[2]), search);
    }
};

/// Writes pair i of a cloth face and a mesh vertex.
struct ReportSheet {
    DeviceSearch search;
    SurfaceView cloth;
    View<const int> sorted; ///< slots in the order of their keys
    Slots sheets;
    PairSlots pair_slots;
    View<ContactPair> pairs; ///< out, up to its capacity

    TOILE_HD void operator()(int i) const
    {
        const long slot = pair_slots.first_sheet() + i;
        if (i >= pair_slots.sheets() || slot >= pairs.size())
            return;
        const int v = sheets.items[sorted[i]], t = sorted[i] % sheets.queries;
        const SurfaceView& mesh = search.mesh.surface;
        const Vec3& x = mesh.positions[v];
        pairs[int(slot)] =
            face_vertex_pair(search.pose(), search.collider, v, mesh.vertex_normal(v), cloth.triangles[t],
                             cloth.surface_point({t, cloth.closest_on(t, x)}, x));
    }
};

/// Writes the pairs of cloth edge e.
struct ReportRidges {
    /// Test already passed when the ridges were kept.
    struct IsKnown {
        TOILE_HD bool operator()(const Vec3& /*c*/, double /*reach*/, const Vec3& /*n*/) const
        {
            return true;
        }
    };

    DeviceSearch search;
    View<const std::array<int, 2>> edge_vertex;
    View<const int> counts; ///< [cloth edges]
    Slots ridges;
    PairSlots pair_slots;
    View<ContactPair> pairs; ///< out, up to its capacity

    TOILE_HD void operator()(int e) const
    {
        const long first = pair_slots.of_edge(e);
        for (int k = 0; k < counts[e] && first + k < pairs.size(); ++k)
            ridge_pair(search, edge_vertex[e], ridges.of(e, k), IsKnown(), pairs[int(first + k)]);
    }
};

/// Counts of a search that the host reads.
struct DetectNumbers {
    long pairs;                 ///< found, even beyond the capacity
    long sheets;                ///< pairs of faces and vertices among them
    int max_sheets, max_ridges; ///< maximum of one query, likewise
};

struct CollectDetectNumbers {
    PairSlots pair_slots;
    View<const long> sheets;                    ///< [1]
    View<const Largest> max_sheets, max_ridges; ///< [1]
    View<DetectNumbers> numbers;                ///< [1] out

    TOILE_HD void operator()(int /*i*/) const
    {
        numbers[0] = {pair_slots.all(), sheets[0], int(max_sheets[0].value), int(max_ridges[0].value)};
    }
};

} // namespace toile::collision
