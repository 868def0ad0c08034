#pragma once

#include "core/compute/implicit_tree.h"
#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

TOILE_HD inline double squared(double x) { return x * x; }

/// View of a ClusterBasis and its tree for kernels, on the CPU or on a GPU.
template <typename Number>
struct BasisView {
    static constexpr int kMaxLevels = 32;

    int rank = 0;                        ///< functions of a cluster
    int first_of_level[kMaxLevels] = {}; ///< first cluster of a level
    int leaf_count = 0;
    View<const Number> leaves;    ///< [leaves][kLeaf][rank]
    View<const Number> transfers; ///< [clusters][rank][rank]

    /// Function r of the moments P_C^T f of one cluster, from its nodes or its children.
    /// @param zero     of type T, which has += and multiplication by a Number on the left
    /// @param value    value(slot) of the field
    /// @param moments  moments[rank * cluster + function], of which the children's are read
    template <typename T, typename Value, typename Moments>
    TOILE_HD T moment(int level, int c, int r, const T& zero, const Value& value,
                      const Moments& moments) const
    {
        const int id = first_of_level[level] + c;
        T sum = zero;
        if (level == 0) {
            const int slot = id * ClusterTree::kLeaf;
            for (int i = 0; i < ClusterTree::kLeaf; ++i)
                sum += leaves[(slot + i) * rank + r] * value(slot + i);
            return sum;
        }
        for (int k = 2 * c; k < 2 * c + 2 && k < level_size(leaf_count, level - 1); ++k) {
            const int child = first_of_level[level - 1] + k;
            for (int s = 0; s < rank; ++s)
                sum += transfers[(child * rank + s) * rank + r] * moments[rank * child + s];
        }
        return sum;
    }

    /// |f|^2 on the nodes of one cluster, from its nodes or its children.
    /// @param zero     of type T, which has += and squared()
    /// @param value    value(slot) of the field
    /// @param squares  squares[cluster], of which the children's are read
    template <typename T, typename Value, typename Squares>
    TOILE_HD T square(int level, int c, const T& zero, const Value& value, const Squares& squares) const
    {
        T sum = zero;
        if (level == 0)
            for (int i = 0; i < ClusterTree::kLeaf; ++i)
                sum += squared(value(c * ClusterTree::kLeaf + i));
        else
            for (int k = 2 * c; k < 2 * c + 2 && k < level_size(leaf_count, level - 1); ++k)
                sum += squares[first_of_level[level - 1] + k];
        return sum;
    }
};

} // namespace toile
