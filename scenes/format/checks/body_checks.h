#pragma once

#include "scenes/format/document.h"
#include "scenes/format/scene.h"

namespace toile::scene_format {

/// Checks solids: names, files, and what they need of the rest of the scene.
/// @throws InvalidInput for the first contradiction
void check_solids(const Document& document, const scenes::Scene& scene);

/// Likewise soft bodies and the avatars that their cores follow.
void check_soft_bodies(const Document& document, const scenes::Scene& scene);

} // namespace toile::scene_format
