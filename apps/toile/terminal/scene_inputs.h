#pragma once

#include "core/base/file_plan.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// Adds every file that the scene reads: its own, meshes of cloths and solids, avatars, and the buffers and
/// images that a glTF refers to.
void add_inputs(FilePlan& plan, const scenes::Scene& scene);

} // namespace toile::app
