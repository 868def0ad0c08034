#pragma once

#include <vector>

#include "quadrature2d/paper/field_domains.h"

namespace toile {

/// S_i of eq. 17: `vertex` and then, one by one, the vertex of the near field that is farthest from those
/// chosen so far (farthest point sampling). Fewer where the near field has fewer vertices; the vertex itself
/// is always first.                                                  [multilevel quadrature for PD,
/// sec. 5.1.2] Distances are taken straight in the UV plane, where the near field is a rectangle without
/// holes; the paper takes geodesic ones.
std::vector<int> near_samples(const UvSurface& surface, const PixelBox& near, int vertex, int count);

} // namespace toile
