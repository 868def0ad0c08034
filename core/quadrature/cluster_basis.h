#pragma once

#include <vector>

#include "core/quadrature/cluster_tree.h"
#include "core/quadrature/moments.h"

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
    ClusterBasis(const ClusterBasis&) = delete; // the view is of its own arrays
    ClusterBasis& operator=(const ClusterBasis&) = delete;

    const ClusterTree& tree() const { return tree_; }

    /// Functions of a cluster: rank_of(extent).
    int rank() const { return rank_; }

    /// [leaves][kLeaf][rank] values of the leaves' functions at their slots, zero where padded.
    View<const double> leaves() const { return leaves_; }

    /// [clusters][rank][rank] entry (s, r): share of a cluster's function s in its parent's function r.
    View<const double> transfers() const { return transfers_; }

    /// The same for kernels.
    const BasisView<double>& view() const { return view_; }

    /// Moments P_C^T f of one cluster, from its nodes or its children.
    /// @param zero     of type T, which has += and multiplication by a double on the left
    /// @param value    value(slot) of the field
    /// @param moments  [rank * clusters]: those of children are read, the cluster's written
    template <typename T, typename Value>
    void gather(int level, int c, const T& zero, const Value& value, View<T> moments) const
    {
        const int id = tree_.first_of_level(level) + c;
        for (int r = 0; r < rank_; ++r)
            moments[rank_ * id + r] = view_.moment(level, c, r, zero, value, moments);
    }

private:
    template <int Rank>
    void fill(View<const Place> places);

    const ClusterTree& tree_;
    int rank_;
    std::vector<double> leaves_, transfers_;
    BasisView<double> view_;
};

} // namespace toile
