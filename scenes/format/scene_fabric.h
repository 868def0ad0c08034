#pragma once

#include "garment/fabric/fabric.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// Material of a cloth of the scene: the scene's fabric of that name, else the preset, with the cloth's
/// thickness if given.
/// @throws InvalidInput naming the scene and the number, if the numbers together make no material (shear
///         stiffer than stretch allows).
garment::Fabric fabric_of(const Scene& scene, const scene::Cloth& cloth);

/// Fabric of a group of a cloth. @throws as fabric_of()
garment::Fabric fabric_of(const Scene& scene, const scene::ClothGroup& group);

} // namespace toile::scenes
