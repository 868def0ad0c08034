#pragma once

/// What ContactDetector's search of one mesh found, as pairs in their order: kernels.

#include "collision/device_detect_kernels.h"

namespace toile {

/// Where the pairs of the three kinds lie: those of query q of a kind from first[begin + q] on.
struct PairPlaces {
    View<const long> first; ///< [vertices + vertices of the mesh + cloth edges + 1]
    int vertices = 0, mesh_vertices = 0;

    TOILE_HD long of_vertex(int v) const { return first[v]; }
    TOILE_HD long of_mesh_vertex(int v) const { return first[vertices + v]; }
    TOILE_HD long of_edge(int e) const { return first[vertices + mesh_vertices + e]; }
    TOILE_HD long all() const { return first[first.size() - 1]; }
    TOILE_HD long first_sheet() const { return first[vertices]; }
    TOILE_HD long sheets() const { return first[vertices + mesh_vertices] - first_sheet(); }
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

/// Keys above all others for the room that pairs leave.
struct ClearSheetKeys {
    View<std::uint64_t> keys; ///< out
    View<int> slots;          ///< out

    TOILE_HD void operator()(int i) const
    {
        keys[i] = ~std::uint64_t(0);
        slots[i] = 0;
    }
};

/// Keys of the pairs of mesh vertex v: by corners of the cloth triangle, then by vertex.
struct KeySheets {
    View<const int> counts; ///< [vertices of the mesh]
    View<const int> rank;   ///< [cloth triangles] place in the order of their corners
    Slots sheets;
    PairPlaces places;
    View<std::uint64_t> keys; ///< out, as far as there is room
    View<int> slots;          ///< out: Slots::of as a number

    TOILE_HD void operator()(int v) const
    {
        const long first = places.of_mesh_vertex(v) - places.first_sheet();
        for (int k = 0; k < counts[v] && first + k < keys.size(); ++k) {
            const int place = int(first + k);
            keys[place] = std::uint64_t(rank[sheets.of(v, k)]) << 32U | unsigned(v);
            slots[place] = k * sheets.queries + v;
        }
    }
};

/// Pair i of a vertex of the mesh and a sheet.
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
        const int t = sheets.items[sorted[i]], v = sorted[i] % sheets.queries;
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
    int most_sheets, most_ridges; ///< of one query, before it was tested which are pairs
};

struct CollectDetectNumbers {
    PairPlaces places;
    View<const Largest> most_sheets, most_ridges; ///< [1]
    View<DetectNumbers> numbers;                  ///< [1] out

    TOILE_HD void operator()(int /*i*/) const
    {
        numbers[0] = {places.all(), places.sheets(), int(most_sheets[0].value), int(most_ridges[0].value)};
    }
};

} // namespace toile
