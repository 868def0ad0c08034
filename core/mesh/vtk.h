#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile {

/// A tetrahedral mesh as stored.
struct TetMesh {
    std::vector<Vec3> positions;          ///< [vertices]
    std::vector<std::array<int, 4>> tets; ///< [tets] positively oriented: (b - a) x (c - a) . (d - a) > 0
};

/// Reads an unstructured grid of linear tetrahedra in the legacy VTK format, ASCII.
/// @throws InvalidInput naming file and place: missing file, another data set or binary, a number that does
/// not
///         parse, an index out of range, a cell that is not a tetrahedron or is flat. Tetrahedra of negative
///         volume are turned.
TetMesh read_vtk_tets(const std::filesystem::path& file);

/// Triangles that belong to one tetrahedron only, counter-clockwise seen from outside, and the vertices that
/// they use, in the order of the tetrahedral mesh.
TriangleMesh boundary_surface(const TetMesh& mesh);

} // namespace toile
