#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/compute/types.h"
#include "core/mesh/triangle_mesh.h"

namespace toile {

/// An edge with its one or two triangles.
//
//        x2
//       /  \          triangle[0] holds (v0, v1) in this order, triangle[1] holds (v1, v0);
//      v0---v1        opposite[0] = x2, opposite[1] = x3.
//       \  /          A border edge has triangle[1] = opposite[1] = -1.
//        x3
struct Edge {
    std::array<int, 2> vertex{};
    std::array<int, 2> triangle{-1, -1};
    std::array<int, 2> opposite{-1, -1};

    bool is_border() const { return triangle[1] < 0; }
};

/// Lists of items per owner in one array: items of owner i are items[first[i] .. first[i + 1]).
struct Incidence {
    std::vector<int> first; ///< [owners + 1]
    std::vector<int> items;

    View<const int> of(int owner) const
    {
        return View<const int>(items.data() + first[owner], first[owner + 1] - first[owner]);
    }
};

/// Adjacency of a triangle surface.
struct Topology {
    std::vector<Edge> edges;                       ///< sorted by (smaller, larger) vertex index
    std::vector<std::array<int, 3>> triangle_edge; ///< [triangles] edge from corner k to corner k + 1
    Incidence corners_of_vertex;                   ///< per vertex: 3 * triangle + corner, ascending

    /// True if there is no border edge.
    bool is_closed() const;
};

/// Builds the topology. O(n log n).
/// @param source  named in errors, e.g. the file
/// @throws InvalidInput naming the first edge with more than two triangles, or with two that run along it in
///         the same direction (flipped winding).
Topology build_topology(View<const Triangle> triangles, int vertex_count, const std::string& source);

/// The same for surfaces that are sewn onto each other, as pockets are. Where three or more triangles share
/// an edge, the two that continue each other most straightly are those of the edge; each of the others has a
/// border edge of its own there, with the same vertices.
/// @throws InvalidInput for two that run along an edge in the same direction, where they can't be paired
Topology build_branching_topology(const TriangleMesh& mesh, const std::string& source);

/// Shape of a triangle surface, whatever its windings. Vertices without a triangle do not count, and neither
/// do collapsed triangles but for being listed.
struct SurfaceTopology {
    int pieces = 0;               ///< sets of triangles joined by edges
    int border_loops = 0;         ///< openings: neck, hem, cuffs
    int euler_characteristic = 0; ///< vertices - edges + triangles; 2 - 2 genus - border loops a piece

    std::vector<std::array<int, 2>> non_manifold_edges; ///< vertices; of three or more triangles, borders
    std::vector<int> collapsed_triangles;               ///< with two corners in one vertex
    std::vector<int> duplicate_triangles;               ///< with the corners of an earlier one

    bool is_manifold() const
    {
        return non_manifold_edges.empty() && collapsed_triangles.empty() && duplicate_triangles.empty();
    }
};

/// O(n log n).
SurfaceTopology surface_topology(View<const Triangle> triangles);

/// Corners (3 * triangle + corner) per vertex, ascending: for gathering per-corner values.
Incidence corners_of_vertices(View<const Triangle> triangles, int vertex_count);

} // namespace toile
