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

/// O(n log n).
SurfaceEdges build_surface_edges(View<const Triangle> triangles, int vertex_count);

} // namespace toile
