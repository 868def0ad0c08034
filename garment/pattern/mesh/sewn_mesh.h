#pragma once

#include <array>
#include <optional>
#include <vector>

#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Topology of a sewn surface.
struct SewnTopology {
    int pieces = 0;               ///< sets of triangles joined by edges
    int border_loops = 0;         ///< openings: neck, hem, cuffs
    int euler_characteristic = 0; ///< vertices - edges + triangles; 2 - 2 genus - border loops a piece

    /// Seam that makes the surface one-sided: a strip of it has its outside inside after one turn. Flip one
    /// of its sides to mend it. None if the surface has two sides.
    std::optional<int> one_sided_seam;

    std::vector<std::array<int, 2>> non_manifold_edges; ///< welded vertices; of three or more triangles
    std::vector<int> collapsed_triangles;               ///< with two corners in one welded vertex
    std::vector<int> duplicate_triangles;               ///< with the corners of an earlier one

    bool is_orientable() const { return !one_sided_seam; }
    bool is_manifold() const
    {
        return non_manifold_edges.empty() && collapsed_triangles.empty() && duplicate_triangles.empty();
    }
};

/// Pattern mesh with stitched vertices welded. Triangle t is that of the pattern mesh; the corners there are
/// its texture coordinates: uv[mesh.triangles[t][k]]. Its corners are reversed in panels that had to be
/// turned.
struct SewnMesh {
    int vertex_count = 0;
    std::vector<Triangle> triangles;       ///< [triangles] windings agree, unless the surface is one-sided
    std::vector<Triangle> corners;         ///< [triangles] the same corners before welding, in the same order
    std::vector<int> welded_of;            ///< [vertices of the pattern mesh] ascending in their first member
    std::vector<std::vector<int>> members; ///< [welded vertices] of the pattern mesh, ascending
    std::vector<bool> is_turned;           ///< [panels] triangles run against the panel's loop
    SewnTopology topology;
};

/// Welds what is stitched. Where a seam joins two panels front to back, one is turned (is_turned); the panel
/// with the lower number of each piece keeps its outside.
SewnMesh sewn_mesh(const PatternMesh& mesh);

/// Number of the welded vertex of each vertex. [vertices of the pattern mesh]
std::vector<int> weld_stitches(const PatternMesh& mesh);

/// Edges inside panels that have both welded ends in common with another edge: pairs of vertices of the
/// pattern mesh, all but one of each set of equal edges. Split, they leave the sewn surface manifold.
std::vector<std::array<int, 2>> edges_to_split(const PatternMesh& mesh);

} // namespace toile::garment
