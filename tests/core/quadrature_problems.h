#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/linear/field.h"
#include "core/linear/global_solver.h"
#include "core/quadrature/cluster_tree.h"
#include "tests/core/matrices.h"

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

/// Largest factor by which x -> x - A H x lengthens a random field in the long run.
inline double contraction(const GlobalSolver& solver, const SparseMatrix& H, int steps = 40)
{
    const int n = int(H.rows());
    std::vector<Vec3> x = random_field(n, 5), product(n), correction(n);
    double ratio = 0.0;
    for (int step = 0; step < steps; ++step) {
        const double before = std::sqrt(dot(x, x));
        for (int i = 0; i < n; ++i)
            product[i] = row_times(H, i, x);
        solver.solve(product, correction);
        axpy(-1.0, correction, x);
        const double after = std::sqrt(dot(x, x));
        ratio = after / before;
        for (Vec3& v : x)
            v /= after;
    }
    return ratio;
}

struct Grid {
    static constexpr int kColumns = 40, kRows = 32;
    std::vector<Place> places = grid_places(kColumns, kRows);
    std::vector<unsigned char> fixed = std::vector<unsigned char>(places.size(), 0);

    /// @param shift  mass over stiffness: the kernel reaches 1 / sqrt(shift) nodes far
    SparseMatrix H(double shift) const { return grid_laplacian(kColumns, kRows, shift); }
};

} // namespace toile::test
