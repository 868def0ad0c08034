#pragma once

#include <array>

#include "volume/mesh/tet_mesh.h"

namespace toile::test {

/// Box [0, size] of cells, each split into six tetrahedra around a diagonal; neighbours mirror
/// each other.
struct Block {
    Vec3 size;
    std::array<int, 3> cells;
    volume::TetMesh mesh;

    int at(int i, int j, int k) const { return i + (cells[0] + 1) * (j + (cells[1] + 1) * k); }
    bool is_on_surface(int vertex) const;
};

/// @param disorder  how far inner vertices are moved, relative to a cell [-]: up to 0.2 leaves all
///                  tetrahedra the right way round
Block make_block(const Vec3& size, const std::array<int, 3>& cells, double disorder = 0.0);

} // namespace toile::test
