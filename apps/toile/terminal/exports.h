#pragma once

#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::app {

/// Exports of the scene: its list, or one PC2 per cloth and solid.
std::vector<scene::Export> exports_of(const scenes::Scene& scene);

/// Names of the scene's cloths and then of its solids: the order of World::surfaces().
std::vector<std::string> surface_names(const scenes::Scene& scene);

/// Index in surface_names() of an export's cloth or solid; an export without a name means the only one.
int surface_index(const scenes::Scene& scene, const std::string& name);

} // namespace toile::app
