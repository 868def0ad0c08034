#pragma once

#include <filesystem>

#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Reads the linear tetrahedra of a Gmsh file of version 2 or 4.1, ASCII or binary
/// [https://gmsh.info/doc/texinfo/gmsh.html, "File formats"]. Corners of tetrahedra with negative volume are
/// swapped; points, lines and faces among the elements are left out, and so are unknown sections.
/// @throws InvalidInput naming file and place: missing file, another version, a number that does not parse or
///         is not finite, a node that does not exist, an element of another type or flat, elements that
///         overlap.
TetMesh read_msh_tets(const std::filesystem::path& file);

} // namespace toile::volume
