#pragma once

#include <vector>

#include "core/quadrature/cluster_tree.h"

namespace toile {

/// Orthonormal functions on the nodes of every cluster, close to 1 and the coordinates along its axes (two on
/// a surface, three in a volume): what a field is reduced to when it is looked at from far away. Nested: a
/// parent's functions are combinations of its children's, so that the moments of all clusters take one pass
/// over the tree.
class ClusterBasis {
public:
    /// @param tree    borrowed; its extent decides the rank
    /// @param places  [n] as the tree's
    ClusterBasis(const ClusterTree& tree, View<const Place> places);

    const ClusterTree& tree() const { return tree_; }

    /// Functions of a cluster: rank_of(extent).
    int rank() const { return rank_; }

    /// [leaves][kLeaf][rank] values of the leaves' functions at their slots, zero where padded.
    View<const double> leaves() const { return leaves_; }

    /// [clusters][rank][rank] entry (s, r): share of a cluster's function s in its parent's function r.
    View<const double> transfers() const { return transfers_; }

    /// Moments P_C^T f of one cluster, from its nodes or its children.
    /// @param zero     of type T, which has += and multiplication by a double on the left
    /// @param value    value(slot) of the field
    /// @param moments  [rank * clusters]: those of children are read, the cluster's written
    template <typename T, typename Value>
    void gather(int level, int c, const T& zero, const Value& value, View<T> moments) const
    {
        const int id = tree_.first_of_level(level) + c;
        for (int r = 0; r < rank_; ++r) {
            T sum = zero;
            if (level == 0)
                for (int i = 0; i < ClusterTree::kLeaf; ++i)
                    sum += leaf_function(id, i, r) * value(id * ClusterTree::kLeaf + i);
            else
                for (int which = 0; which < 2; ++which)
                    if (const int child = tree_.child(level, c, which); child >= 0)
                        for (int s = 0; s < rank_; ++s)
                            sum += transfer(child, s, r) * moments[rank_ * child + s];
            moments[rank_ * id + r] = sum;
        }
    }

private:
    template <int Rank>
    void fill(View<const Place> places);

    double leaf_function(int leaf, int i, int r) const
    {
        return leaves_[size_t(leaf * ClusterTree::kLeaf + i) * rank_ + r];
    }
    double transfer(int cluster, int s, int r) const
    {
        return transfers_[size_t(cluster * rank_ + s) * rank_ + r];
    }

    const ClusterTree& tree_;
    int rank_;
    std::vector<double> leaves_, transfers_;
};

} // namespace toile
