#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/linear/field.h"
#include "core/linear/global_solver.h"
#include "core/quadrature/clusters/cluster_tree.h"
#include "tests/core/linear/matrices.h"
#include "tests/support/contraction.h"

/// Bodies for the tests of quadrature, and measures of their solution.
namespace toile::test {

/// Nodes of a columns x rows x layers grid at unit distance.
inline std::vector<EmbeddedPoint> grid_points(int columns, int rows, int layers = 1)
{
    std::vector<EmbeddedPoint> points;
    for (int k = 0; k < layers; ++k)
        for (int j = 0; j < rows; ++j)
            for (int i = 0; i < columns; ++i) {
                points.emplace_back(EmbeddedPoint::Zero());
                points.back().head<3>() << i, j, k;
            }
    return points;
}

inline std::vector<int> all_nodes(const std::vector<EmbeddedPoint>& points)
{
    std::vector<int> nodes(points.size());
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
    std::vector<EmbeddedPoint> points = grid_points(kColumns, kRows);
    std::vector<unsigned char> fixed = std::vector<unsigned char>(points.size(), 0);

    /// @param shift  mass over stiffness: the range of the kernel is 1 / sqrt(shift) nodes
    SparseMatrix matrix(double shift) const { return grid_laplacian(kColumns, kRows, shift); }
};

} // namespace toile::test
