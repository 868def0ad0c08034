#pragma once

#include <vector>

#include "research/paper_rule/field_domains.h"

namespace toile::research {

/// Farthest-point samples S_i of eq. 17 [multilevel quadrature for PD, sec. 5.1.2]. `vertex` comes first,
/// then one by one the vertex of the near field with the largest distance from those chosen so far. Fewer if
/// the near field has fewer vertices.
///
/// Distances are straight, since the near field is a box without holes; the paper takes geodesic ones.
template <int Dim>
std::vector<int> near_samples(const VoxelisedMesh<Dim>& mesh, const VoxelBox<Dim>& near, int vertex,
                              int count);

} // namespace toile::research
