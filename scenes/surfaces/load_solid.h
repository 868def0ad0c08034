#pragma once

#include <string>

#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// Name of the solid in errors: its file, or solid "name".
std::string source_of(const scene::Solid& solid);

/// Surface of a solid at its start placement.
/// @throws InvalidInput for an unusable mesh
ClothState load_solid(const scene::Solid& solid);

} // namespace toile::scenes
