#pragma once

#include "garment/fabric/fabric.h"
#include "scenes/format/scene.h"

namespace toile {

/// The material of a cloth of the scene: the scene's own fabric of that name or else the preset, and the
/// cloth's thickness if it has one.
/// @throws InvalidInput naming the scene and the number, when the numbers together make no material
///         (shear stiffer than stretch allows).
Fabric fabric_of(const Scene& scene, const scene::Cloth& cloth);

} // namespace toile
