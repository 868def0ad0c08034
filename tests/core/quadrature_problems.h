#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/linear/field.h"
#include "core/linear/global_solver.h"
#include "core/quadrature/cluster_tree.h"
#include "tests/core/matrices.h"
#include "tests/support/contraction.h"

/// Bodies for the tests of quadrature, and what is measured on them.
namespace toile::test {

/// Nodes of a columns x rows x layers grid at unit distance.
inline std::vector<Place> grid_places(int columns, int rows, int layers = 1)
{
    std::vector<Place> places;
    for (int k = 0; k < layers; ++k)
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                places.emplace_back(Place::Zero());
                places.back().head<3>() << i, j, k;
            }
    return places;
}

inline std::vector<int> all_nodes(const std::vector<Place>& places)
{
    std::vector<int> nodes(places.size());
    for (size_t v = 0; v < nodes.size(); ++v)
        nodes[v] = int(v);
    return nodes;
}

/// Nodes below a cluster.
inline std::vector<int> nodes_below(const ClusterTree& tree, int level, int c)
{
    std::vector<int> nodes;
    for (int slot = (c << level) * ClusterTree::kLeaf;
         slot < std::min<int>((c + 1) << level, tree.leaf_count()) * ClusterTree::kLeaf; ++slot)
        if (tree.nodes()[slot] >= 0)
            nodes.push_back(tree.nodes()[slot]);
    return nodes;
}

/// Contraction of x -> x - A H x, from a rough field.
inline double contraction(const GlobalSolver& solver, const SparseMatrix& H)
{
    return contraction(solver, H, random_field(int(H.rows()), 5), 40);
}

struct Grid {
    static constexpr int kColumns = 40, kRows = 32;
    std::vector<Place> places = grid_places(kColumns, kRows);
    std::vector<unsigned char> fixed = std::vector<unsigned char>(places.size(), 0);

    /// @param shift  mass over stiffness: the kernel reaches 1 / sqrt(shift) nodes far
    SparseMatrix matrix(double shift) const { return grid_laplacian(kColumns, kRows, shift); }
};

} // namespace toile::test
