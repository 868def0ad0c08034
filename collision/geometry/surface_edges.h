#pragma once

#include <array>
#include <vector>

#include "core/compute/types.h"
#include "core/mesh/topology.h"

namespace toile::collision {

/// Edges and incidences of any triangle list. Unlike build_topology it accepts every input: colliders may be
/// non-manifold or wound inconsistently, and proximity needs only incidences.
struct SurfaceEdges {
    std::vector<std::array<int, 2>> vertex;        ///< [edges] smaller index first; sorted
    Incidence triangles;                           ///< per edge, ascending
    std::vector<std::array<int, 3>> triangle_edge; ///< [triangles] edge from corner k to corner k + 1
    Incidence corners_of_vertex;                   ///< per vertex: 3 * triangle + corner, ascending

    int edge_count() const { return int(vertex.size()); }

    /// True if the surface has an inside: every edge is used equally often in both directions.
    bool is_closed = false;
};

/// Borrowed lists of items per owner: an Incidence for kernels.
struct IncidenceView {
    View<const int> first, items;

    TOILE_HD View<const int> of(int owner) const
    {
        return items.subview(first[owner], first[owner + 1] - first[owner]);
    }
};

/// Borrowed SurfaceEdges, on the host or on a GPU.
struct SurfaceEdgesView {
    View<const std::array<int, 2>> vertex;
    IncidenceView triangles;
    View<const std::array<int, 3>> triangle_edge;
    IncidenceView corners_of_vertex;

    /// Whether side k of triangle t is the first occurrence of edge e. True for one side only, even if a
    /// collapsed triangle has the edge twice.
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

/// Ranks of triangles in the lexicographic order of their corners as listed; equal triangles share a rank.
/// O(n log n).
std::vector<int> ranks_by_corners(View<const Triangle> triangles);

/// Builds edges and incidences. O(n log n).
SurfaceEdges build_surface_edges(View<const Triangle> triangles, int vertex_count);

} // namespace toile::collision
