#pragma once

#include <vector>

#include "core/quadrature/clusters/moments.h"

/// Test for clusters that are far from a leaf (KernelTable::Settings::tolerance), on the CPU and on a GPU.
namespace toile {

/// |G_iC - P_C P_C^T G_iC|^2 of one column.
///
/// Rows: projection of the kernel's rows of some targets onto clusters, one column per target:
///   rank()                            functions of a cluster
///   moment(cluster, function, column) P_C^T G_iC
///   square(cluster, column)           |G_iC|^2
template <typename Rows>
TOILE_HD double squared_error(const Rows& rows, int cluster, int column)
{
    double rest = rows.square(cluster, column);
    for (int r = 0; r < rows.rank(); ++r) {
        const double moment = rows.moment(cluster, r, column);
        rest -= moment * moment;
    }
    return rest;
}

/// True if a cluster's functions represent the rows of a leaf accurately enough.
struct FarTest {
    View<const int> nodes;       ///< [slots] -1 where padded
    View<const double> diagonal; ///< [n] of H
    View<const double> limits;   ///< [clusters] far_limits()

    /// @param column  of the leaf's first target
    template <typename Rows>
    TOILE_HD bool operator()(const Rows& rows, int cluster, int leaf, int column) const
    {
        for (int t = 0; t < ClusterTree::kLeaf; ++t) {
            const int v = nodes[leaf * ClusterTree::kLeaf + t];
            if (v >= 0 && diagonal[v] * squared_error(rows, cluster, column + t) > limits[cluster])
                return false;
        }
        return true;
    }
};

/// Largest H_ii |G_iC - P_C P_C^T G_iC|^2 for which a cluster is far. [clusters]
/// @param diagonal  [n] of H
std::vector<double> far_limits(const ClusterTree& tree, View<const double> diagonal, double tolerance);

/// Visits the clusters below one, depth first: the largest far ones, and leaves that are not far.
/// @param is_far  is_far(cluster)
/// @param lists   receives far(cluster) and near(leaf) in the order of the visit
template <typename Number, typename IsFar, typename Lists>
TOILE_HD void descend(const BasisView<Number>& tree, int top_level, int top, const IsFar& is_far,
                      Lists& lists)
{
    int level = top_level, c = top;
    while (true) {
        const int id = tree.first_of_level[level] + c;
        const bool far = is_far(id);
        if (!far && level > 0) {
            --level;
            c *= 2;
            continue;
        }
        far ? lists.far(id) : lists.near(c);

        // Go to the sibling, or to the next unvisited sibling of the nearest ancestor.
        while (level < top_level && (c % 2 == 1 || c + 1 == level_size(tree.leaf_count, level))) {
            ++level;
            c /= 2;
        }
        if (level == top_level)
            return;
        ++c;
    }
}

} // namespace toile
