#pragma once

#include <vector>

#include "research/paper_rule/field_domains.h"

namespace toile::research {

/// Farthest-point samples S_i of eq. 17 [multilevel quadrature for PD, sec. 5.1.2]. `vertex` comes first,
/// then one by one the vertex of the near field with the largest distance from those chosen so far. Fewer if
/// the near field has fewer vertices.
///
/// Distances are straight in the UV plane, where the near field is a rectangle without holes; the paper takes
/// geodesic ones.
std::vector<int> near_samples(const UvSurface& surface, const PixelBox& near, int vertex, int count);

} // namespace toile::research
