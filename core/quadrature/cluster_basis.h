#pragma once

#include <vector>

#include "core/quadrature/cluster_tree.h"

namespace toile {

/// Orthonormal functions on the nodes of every cluster, close to 1 and the two coordinates along its axes:
/// what a field is reduced to when it is looked at from far away. Nested: a parent's functions are
/// combinations of its children's, so that the moments of all clusters take one pass over the tree.
class ClusterBasis {
public:
    static constexpr int kRank = 3;
    using Transfer = Eigen::Matrix<double, kRank, kRank>;
    using LeafFunctions = Eigen::Matrix<double, ClusterTree::kLeaf, kRank>;

    /// @param tree    borrowed
    /// @param places  [n] as the tree's
    ClusterBasis(const ClusterTree& tree, View<const Place> places);

    const ClusterTree& tree() const { return tree_; }
    const LeafFunctions& leaf(int leaf) const { return leaf_[leaf]; }

    /// Moments P_C^T f of one cluster, from its nodes or its children.
    /// @param zero     of type T, which has += and multiplication by a double on the left
    /// @param value    value(slot) of the field
    /// @param moments  [kRank * clusters]: those of children are read, the cluster's written
    template <typename T, typename Value>
    void gather(int level, int c, const T& zero, const Value& value, View<T> moments) const
    {
        const int id = tree_.first_of_level(level) + c;
        for (int r = 0; r < kRank; ++r) {
            T sum = zero;
            if (level == 0)
                for (int i = 0; i < ClusterTree::kLeaf; ++i)
                    sum += leaf_[id](i, r) * value(id * ClusterTree::kLeaf + i);
            else
                for (int which = 0; which < 2; ++which)
                    if (const int child = tree_.child(level, c, which); child >= 0)
                        for (int s = 0; s < kRank; ++s)
                            sum += to_parent_[child](s, r) * moments[kRank * child + s];
            moments[kRank * id + r] = sum;
        }
    }

private:
    const ClusterTree& tree_;
    std::vector<LeafFunctions> leaf_; ///< [leaves] zero rows where padded
    std::vector<Transfer> to_parent_; ///< [clusters] parent's functions in terms of the cluster's
};

} // namespace toile
