#pragma once

#include <string>
#include <vector>

#include "garment/energy/rest_shape.h"
#include "garment/seam/elastics.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// Springs of a cloth's elastics: one for each edge of the mesh that they run along.
/// @param rest      of the cloth: gives the lengths of its edges
/// @param key_path  of the list, for messages
/// @throws InvalidInput naming the elastic and its vertices, if two in a row share no edge
std::vector<garment::Elastics::Spring> elastic_springs(const std::vector<scene::Elastic>& elastics,
                                                       const ClothState& cloth,
                                                       const garment::RestShape& rest,
                                                       const std::string& key_path);

} // namespace toile::scenes
