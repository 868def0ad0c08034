#pragma once

#include <array>
#include <vector>

#include "core/backend/types.h"
#include "core/mesh/topology.h"

namespace toile {

/// Edges and incidences of any triangle list. Unlike build_topology it refuses nothing: obstacles may be
/// non-manifold or wound inconsistently, and proximity needs only to know who shares what.
struct SurfaceEdges {
    std::vector<std::array<int, 2>> vertex;        ///< [edges] smaller index first; sorted
    Incidence triangles;                           ///< per edge, ascending
    std::vector<std::array<int, 3>> triangle_edge; ///< [triangles] edge from corner k to corner k + 1
    Incidence corners_of_vertex;                   ///< per vertex: 3 * triangle + corner, ascending

    int edge_count() const { return int(vertex.size()); }

    /// The surface has an inside: every edge is run through as often one way as the other.
    bool is_closed = false;
};

/// Borrowed lists of items per owner: what kernels take of an Incidence.
struct IncidenceView {
    View<const int> first, items;

    TOILE_HD View<const int> of(int owner) const
    {
        return items.subview(first[owner], first[owner + 1] - first[owner]);
    }
};

/// Borrowed SurfaceEdges, of the host or on a GPU.
struct SurfaceEdgesView {
    View<const std::array<int, 2>> vertex;
    IncidenceView triangles;
    View<const std::array<int, 3>> triangle_edge;
    IncidenceView corners_of_vertex;

    /// Whether edge e is met first as side k of triangle t: once of all, though a collapsed triangle may have
    /// it twice.
    TOILE_HD bool is_met_first(int e, int t, int k) const
    {
        for (int before = 0; before < k; ++before)
            if (triangle_edge[t][before] == e)
                return false;
        return triangles.of(e)[0] == t;
    }
};
inline SurfaceEdgesView view_of(const SurfaceEdges& edges)
{
    return {edges.vertex,
            {edges.triangles.first, edges.triangles.items},
            edges.triangle_edge,
            {edges.corners_of_vertex.first, edges.corners_of_vertex.items}};
}

/// Places of triangles in the order of their corners, as they are listed; equal ones share a place.
/// O(n log n).
std::vector<int> ranks_by_corners(View<const Triangle> triangles);

/// O(n log n).
SurfaceEdges build_surface_edges(View<const Triangle> triangles, int vertex_count);

} // namespace toile
