#pragma once

#include <vector>

#include "scenes/drape/garment_mesh.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// Welded vertices along a part of an edge; two at least. It begins and ends at those nearest to its ends.
std::vector<int> path_along(const garment::EdgePart& part, const GarmentMesh& mesh);

/// Elastics of a pattern as paths of welded vertices, one for each edge or part of one. Parts begin and end
/// at the vertices nearest to their ends.
std::vector<scene::Elastic> elastics_of(const garment::Pattern& pattern, const GarmentMesh& mesh);

} // namespace toile::scenes
