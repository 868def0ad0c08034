#pragma once

#include "scenes/format/document.h"
#include "scenes/format/scene.h"

namespace toile::scene_format {

/// Checks the caches that a scene exports: formats, files inside the output folder and each once, surfaces
/// that exist and fit their format, and samples per frame that a run can have.
/// @throws InvalidInput for the first contradiction
void check_exports(const Document& document, const scenes::Scene& scene);

} // namespace toile::scene_format
