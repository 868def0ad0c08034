#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/mesh/topology.h"
#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Topology of a sewn surface, by its welded vertices. What is sewn to lines inside of panels, as pockets
/// are, belongs to its piece; border loops and manifoldness are those without these seams.
struct SewnTopology : SurfaceTopology {
    /// Seam that makes the surface one-sided: a strip of it has its outside inside after one turn. Flip one
    /// of its sides to mend it. None if the surface has two sides.
    std::optional<int> one_sided_seam;

    bool is_orientable() const { return !one_sided_seam; }
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
