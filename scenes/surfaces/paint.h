#pragma once

#include <string>

#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// Sets the stiffness of a cloth's triangles and the thickness of its vertices by the colours of its mesh. A
/// triangle has the mean of its corners.
/// @param source  name of the mesh in errors
/// @throws InvalidInput naming the first vertex without a colour, or with one that is not from 0 to 1
void take_paint(const scene::Painted& painted, const std::string& source, ClothState& state);

} // namespace toile::scenes
