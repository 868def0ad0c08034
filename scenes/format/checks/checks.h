#pragma once

#include "scenes/format/document.h"
#include "scenes/format/scene.h"

namespace toile::scene_format {

/// Checks that involve several keys: names that must be unique or exist, keys that exclude each other,
/// keyframes in order, meshes of a feasible size.
/// @throws InvalidInput for the first contradiction, in the order of the document.
void require_consistent(const Document& document, const scenes::Scene& scene);

} // namespace toile::scene_format
