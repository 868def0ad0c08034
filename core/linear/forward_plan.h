#pragma once

#include <vector>

#include "core/linear/inverted_factor.h"

namespace toile {

/// Up to kRows consecutive rows of a node's block or front.
struct RowTile {
    static constexpr int kRows = 32;

    int node = 0;
    int first_row = 0; ///< first of at most kRows
};

/// Tiles of all levels, the roots' level first.
struct LevelTiles {
    std::vector<RowTile> tiles;
    std::vector<int> first; ///< [levels + 1]
};

/// Tiles over every node's columns.
LevelTiles tiles_of_columns(const InvertedFactor& factor);

/// Plan of forward substitution for a block of unit vectors. It visits the nodes between their rows and the
/// roots. Each of these has a front, with a row for every row of the node's block.
struct ForwardPlan {
    std::vector<int> front_of; ///< [nodes] first row of the node's front, -1 where it is not visited
    int front_rows = 0;        ///< of all fronts
    LevelTiles tiles;          ///< of the fronts' rows
};

/// @param rows  of the unit vectors, -1 for a zero column
ForwardPlan plan_forward(const InvertedFactor& factor, View<const int> rows);

} // namespace toile
