#pragma once

#include <vector>

#include "core/quadrature/moments.h"

/// Which clusters are far from a leaf (KernelTable::Settings::tolerance), on the CPU and on a GPU.
namespace toile {

/// Rows: what clusters carry of the kernel's rows of some targets, a column each:
///   rank()                            functions of a cluster
///   moment(cluster, function, column) P_C^T G_iC
///   square(cluster, column)           |G_iC|^2
///
/// |G_iC - P_C P_C^T G_iC|^2 of one column
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

/// True where a cluster's functions carry the rows of a leaf accurately enough.
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

/// Largest H_ii |G_iC - P_C P_C^T G_iC|^2 of the clusters that are far.
/// @param diagonal  [n] of H
std::vector<double> far_limits(const ClusterTree& tree, View<const double> diagonal, double tolerance);

/// Visits the clusters below one, depth first: the largest that are far, and leaves that are not.
/// @param is_far  is_far(cluster)
/// @param lists   far(cluster) and near(leaf) are called in that order
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

        // On to the sibling, or to that of the nearest ancestor that has one still to come.
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
