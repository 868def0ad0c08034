#pragma once

#include <vector>

#include "collision/contact.h"
#include "scenes/scene_cloth.h"
#include "scenes/scene_solids.h"

namespace toile {

/// A scene's contact as Contact takes it.
Contact::Settings contact_settings(const Scene& scene);

/// Gaps, thicknesses and friction of the cloths and then of the solids.
/// @param solids  null: none
std::vector<ContactCloth> contact_cloths(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                         const SceneSolids* solids, const std::vector<Obstacle>& obstacles);

std::vector<ContactPartner> contact_partners(const std::vector<Obstacle>& obstacles);

} // namespace toile
