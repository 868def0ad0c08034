#pragma once

#include <string>

#include "core/mesh/obj.h"
#include "scenes/format/scene.h"

namespace toile {

/// What errors call the cloth's mesh: its file, or cloth "name".
std::string source_of(const scene::Cloth& cloth);

/// Reads or cuts the cloth, subdivides, sizes and turns it. Where it goes is left to the caller: equal cloths
/// in several places then have the same rest shape to the bit, and so share factors and tables.
/// @param turned_faces  out: faces whose winding had to be turned to agree with their neighbours
/// @throws InvalidInput for a mesh that does not work
ObjMesh turned_mesh(const scene::Cloth& cloth, int& turned_faces);

} // namespace toile
