#pragma once

#include <filesystem>

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Reads an unstructured grid of linear tetrahedra in the legacy VTK format, ASCII or binary, of any version.
/// Corners of tetrahedra with negative volume are swapped; points, lines and faces among the cells are left
/// out.
/// @throws InvalidInput naming file and line: missing file, another data set, a number that does not parse or
///         is not finite, an index out of range, a cell of another type or flat, cells that overlap.
TetMesh read_vtk_tets(const std::filesystem::path& file);

} // namespace toile::volume
