#pragma once

/// What ContactDetector's search of one mesh found, as pairs in their order: kernels.

#include "collision/device_detect_kernels.h"

namespace toile {

/// Where the pairs of the three kinds lie: those of item i of a kind from first[begin + i] on.
struct PairPlaces {
    View<const long> first; ///< [vertices + room for sheets + cloth edges + 1]
    int vertices = 0, sheet_room = 0;

    TOILE_HD long of_vertex(int v) const { return first[v]; }
    TOILE_HD long of_edge(int e) const { return first[vertices + sheet_room + e]; }
    TOILE_HD long all() const { return first[first.size() - 1]; }
    TOILE_HD long first_sheet() const { return first[vertices]; }
    TOILE_HD long sheets() const { return first[vertices + sheet_room] - first_sheet(); }
};

/// Pairs of cloth vertex v.
struct ReportPlanes {
    DeviceSearch search;
    View<const int> counts; ///< [vertices]
    Slots planes;
    PairPlaces places;
    View<ContactPair> pairs; ///< out, as far as there is room

    TOILE_HD void operator()(int v) const
    {
        const Vec3& x = search.x[v];
        const SurfaceView& mesh = search.mesh.surface;
        const long first = places.of_vertex(v);
        for (int k = 0; k < counts[v] && first + k < pairs.size(); ++k) {
            const int t = planes.of(v, k);
            pairs[int(first + k)] = vertex_face_pair(search.pose(), search.collider, v, x,
                                                     mesh.surface_point({t, mesh.closest_on(t, x)}, x));
        }
    }
};

/// Above the keys of all sheets: of the room that they leave.
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

/// Keys of the sheets that cloth triangle t may be: by vertex of the mesh, then by triangle.
struct KeySheets {
    View<const long> first; ///< [cloth triangles + 1] sums of what they have found
    Slots sheets;
    View<std::uint64_t> keys; ///< out, as far as there is room
    View<int> slots;          ///< out: where in the slots' items

    TOILE_HD void operator()(int t) const
    {
        const int count = std::min(int(first[t + 1] - first[t]), sheets.room());
        for (int k = 0; k < count && first[t] + k < keys.size(); ++k) {
            const int place = int(first[t] + k);
            keys[place] = std::uint64_t(sheets.of(t, k)) * sheets.queries + t;
            slots[place] = k * sheets.queries + t;
        }
    }
};

/// Keeps sheet i if it makes a pair; of several at one point the lowest. Keys of pairs: by corners of the
/// cloth triangle, then by vertex of the mesh.
struct KeepSheets {
    DeviceSearch search;
    SurfaceView cloth;
    Slots sheets;
    View<const int> sorted;   ///< [room] slots by vertex of the mesh, then by triangle
    View<const int> rank;     ///< [cloth triangles] place in the order of their corners
    View<int> counts;         ///< [room] out: 0 or 1
    View<std::uint64_t> keys; ///< [room] out
    View<int> slots;          ///< [room] out

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
        const Vec3 own = point(i, x);
        for (int k = i - 1; k >= 0 && vertex(k) == v; --k)
            if ((point(k, x) - own).squaredNorm() < kSamePoint * kSamePoint)
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

/// Pair i of a face of cloth and a vertex of the mesh.
struct ReportSheet {
    DeviceSearch search;
    SurfaceView cloth;
    View<const int> sorted; ///< slots in the order of their keys
    Slots sheets;
    PairPlaces places;
    View<ContactPair> pairs; ///< out, as far as there is room

    TOILE_HD void operator()(int i) const
    {
        const long place = places.first_sheet() + i;
        if (i >= places.sheets() || place >= pairs.size())
            return;
        const int v = sheets.items[sorted[i]], t = sorted[i] % sheets.queries;
        const SurfaceView& mesh = search.mesh.surface;
        const Vec3& x = mesh.positions[v];
        pairs[int(place)] =
            face_vertex_pair(search.pose(), search.collider, v, mesh.vertex_normal(v), cloth.triangles[t],
                             cloth.surface_point({t, cloth.closest_on(t, x)}, x));
    }
};

/// Pairs of cloth edge e.
struct ReportRidges {
    /// Was asked when the ridges were kept.
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
    PairPlaces places;
    View<ContactPair> pairs; ///< out, as far as there is room

    TOILE_HD void operator()(int e) const
    {
        const long first = places.of_edge(e);
        for (int k = 0; k < counts[e] && first + k < pairs.size(); ++k)
            ridge_pair(search, edge_vertex[e], ridges.of(e, k), IsKnown(), pairs[int(first + k)]);
    }
};

/// What the host wants to know of a search.
struct DetectNumbers {
    long pairs;                   ///< found, whether there was room or not
    long sheets;                  ///< of them those of faces and vertices
    int most_sheets, most_ridges; ///< of one query, likewise
};

struct CollectDetectNumbers {
    PairPlaces places;
    View<const long> sheets;                      ///< [1]
    View<const Largest> most_sheets, most_ridges; ///< [1]
    View<DetectNumbers> numbers;                  ///< [1] out

    TOILE_HD void operator()(int /*i*/) const
    {
        numbers[0] = {places.all(), sheets[0], int(most_sheets[0].value), int(most_ridges[0].value)};
    }
};

} // namespace toile
