#pragma once

#include <array>

#include "volume/mesh/tet_mesh.h"

namespace toile::research {

/// The box [0, size] of cells, each of six tetrahedra around their diagonal.
volume::TetMesh bar_of_tets(const Vec3& size, const std::array<int, 3>& cells);

} // namespace toile::research
