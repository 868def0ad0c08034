#pragma once

#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile {

/// What the scene exports: its list, or one PC2 per cloth and solid.
std::vector<scene::Export> exports_of(const Scene& scene);

/// Names of the scene's cloths and then of its solids: the order of World::surfaces().
std::vector<std::string> surface_names(const Scene& scene);

/// Index in surface_names() of the cloth or solid that an export names; without a name the scene has only
/// one.
int surface_index(const Scene& scene, const std::string& name);

} // namespace toile
