#pragma once

#include <string>

#include "core/mesh/obj.h"

namespace toile::scenes {

/// Checks that texture coordinates can be a rest shape: every triangle has an area in the texture plane, and
/// no polygon folds over itself. Panels may lie on each other, and halves of a garment may share the texture
/// of their common edge and mirror each other.
/// @throws InvalidInput naming `source`, the line of the first face that is wrong, and a remedy
void require_flat_texture(const ObjMesh& mesh, const std::string& source);

} // namespace toile::scenes
