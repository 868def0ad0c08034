#pragma once

#include <vector>

#include "apps/preview/image.h"
#include "apps/toile/maps/vertex_map.h"

namespace toile::app {

/// Maps of a garment on its body, each from the front and from the back beside its colour bar. [maps]
/// @param front  direction that the body faces, horizontal
std::vector<preview::Image> fit_pictures(const FittedGarment& garment, const std::vector<VertexMap>& maps,
                                         const TriangleMesh& body, const Vec3& front);

/// Colours of a map. [vertices] sRGB in [0, 1]
std::vector<Vec3> colours_of(const VertexMap& map);

} // namespace toile::app
