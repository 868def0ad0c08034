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

/// Writes a Gmsh file of version 4.1 in ASCII: nodes and elements from 1, in the mesh's order. Numbers read
/// back as the same.
/// @throws InvalidInput if it can't be created; DeviceError if the write breaks off, with nothing left
void write_msh(const std::filesystem::path& file, const TetMesh& mesh);

} // namespace toile::volume
