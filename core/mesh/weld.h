#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Welded mesh and the origin of its vertices.
struct Welded {
    TriangleMesh mesh;
    std::vector<int> welded_of; ///< [old vertices] index in mesh
    std::vector<int> source_of; ///< [new vertices] the first old vertex merged into it
};

/// Merges vertices at most `distance` [m] apart and drops triangles that lose a corner. Uses grid hashing;
/// the lowest index survives; 0 merges only equal positions. Positions must be finite. A merge that makes an
/// edge non-manifold is not undone here.
Welded weld(const TriangleMesh& mesh, double distance);

} // namespace toile
