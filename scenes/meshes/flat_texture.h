#pragma once

#include <string>

#include "core/mesh/obj.h"

namespace toile::scenes {

/// Checks that texture coordinates can be a rest shape: every triangle has an area in the texture plane, and
/// panels do not fold over. A panel is a set of triangles that share edges there too. Panels may lie on each
/// other, and may be mirrored.
/// @throws InvalidInput naming `source`, the line of the first face that is wrong, and a remedy
void require_flat_texture(const ObjMesh& mesh, const std::string& source);

} // namespace toile::scenes
