#pragma once

#include <vector>

#include "core/linear/inverted_factor.h"

namespace toile {

/// Some rows of a node's block or front.
struct RowTile {
    static constexpr int kRows = 32;

    int node = 0;
    int first_row = 0; ///< of at most kRows
};

/// Tiles of all levels, the roots' first.
struct LevelTiles {
    std::vector<RowTile> tiles;
    std::vector<int> first; ///< [levels + 1]
};

/// The tiles of every node's columns.
LevelTiles tiles_of_columns(const InvertedFactor& factor);

/// What forward substitution does for a block of unit vectors: it visits the nodes between them and the
/// roots, and keeps a front for each, a row for every row of its block.
struct ForwardPlan {
    std::vector<int> front_of; ///< [nodes] first row of the node's front, -1 where it is not visited
    int front_rows = 0;        ///< of all fronts
    LevelTiles tiles;          ///< of the fronts' rows
};

/// @param rows  of the unit vectors, -1 where there is none
ForwardPlan plan_forward(const InvertedFactor& factor, View<const int> rows);

} // namespace toile
