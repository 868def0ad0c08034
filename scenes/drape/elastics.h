#pragma once

#include <vector>

#include "scenes/drape/garment_mesh.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// Elastics of a pattern as paths of welded vertices, one for each edge or part of one. Parts begin and end
/// at the vertices nearest to their ends.
std::vector<scene::Elastic> elastics_of(const garment::Pattern& pattern, const GarmentMesh& mesh);

} // namespace toile::scenes
