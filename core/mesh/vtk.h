#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Tetrahedral mesh as stored.
struct TetMesh {
    std::vector<Vec3> positions;          ///< [vertices]
    std::vector<std::array<int, 4>> tets; ///< [tets] positively oriented: (b - a) x (c - a) . (d - a) > 0
};

/// Reads an unstructured grid of linear tetrahedra in the legacy VTK format, ASCII or binary, of any version.
/// Corners of tetrahedra with negative volume are swapped; points, lines and faces among the cells are left
/// out.
/// @throws InvalidInput naming file and line: missing file, another data set, a number that does not parse or
///         is not finite, an index out of range, a cell of another type or flat, cells that overlap.
TetMesh read_vtk_tets(const std::filesystem::path& file);

/// Triangles that belong to only one tetrahedron, counter-clockwise seen from outside. Their vertices keep
/// the order of the tetrahedral mesh.
TriangleMesh boundary_surface(const TetMesh& mesh);

} // namespace toile
