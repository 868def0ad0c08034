#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile {

/// A welded mesh and where its vertices came from.
struct Welded {
    TriangleMesh mesh;
    std::vector<int> welded_of; ///< [old vertices] index in mesh
    std::vector<int> source_of; ///< [new vertices] the first old vertex merged into it
};

/// Merges vertices at most `distance` [m] apart (grid hashing; the lowest index survives; 0 merges equal
/// positions only) and drops triangles that lose a corner. Merging that would make an edge non-manifold is
/// not undone here. Positions must be finite.
Welded weld(const TriangleMesh& mesh, double distance);

} // namespace toile
