#pragma once

#include <string>

#include "core/mesh/obj.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// Name of the cloth's mesh in errors: its file, or cloth "name".
std::string source_of(const scene::Cloth& cloth);

/// Reads or cuts the cloth, subdivides, scales and rotates it. Translation is left to the caller: equal
/// cloths at several positions then have bitwise equal rest shapes and share factors and tables.
/// @param flipped_faces  out: faces whose winding was flipped to agree with their neighbours
/// @throws InvalidInput for an unusable mesh
ObjMesh oriented_mesh(const scene::Cloth& cloth, int& flipped_faces);

} // namespace toile::scenes
