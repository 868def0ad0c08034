#pragma once

#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile {

/// What the scene exports: its list, or one PC2 per cloth.
std::vector<scene::Export> exports_of(const Scene& scene);

/// Index in Scene::cloths of the cloth that an export names; without a name the scene has one cloth.
int cloth_index(const Scene& scene, const std::string& name);

} // namespace toile
