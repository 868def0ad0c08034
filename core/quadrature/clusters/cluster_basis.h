#pragma once

#include <vector>

#include "core/quadrature/clusters/cluster_tree.h"
#include "core/quadrature/clusters/moments.h"

namespace toile {

/// Orthonormal functions on the nodes of every cluster, close to 1 and the coordinates along its axes (two on
/// a surface, three in a volume). They represent a field in the far field. Nested: a parent's functions are
/// combinations of its children's, so one pass over the tree gives the moments of all clusters.
class ClusterBasis {
public:
    /// @param tree    borrowed; its extent determines the rank
    /// @param points  [n] the tree's
    ClusterBasis(const ClusterTree& tree, View<const EmbeddedPoint> points);
    ClusterBasis(const ClusterBasis&) = delete; // the view is of its own arrays
    ClusterBasis& operator=(const ClusterBasis&) = delete;

    const ClusterTree& tree() const { return tree_; }

    /// Functions of a cluster: rank_of(extent).
    int rank() const { return rank_; }

    /// [leaves][kLeaf][rank] values of the leaves' functions at their slots, zero where padded.
    View<const double> leaves() const { return leaves_; }

    /// [clusters][rank][rank] entry (s, r): coefficient of a cluster's function s in its parent's function r.
    View<const double> transfers() const { return transfers_; }

    /// View for kernels.
    const BasisView<double>& view() const { return view_; }

    /// Moments P_C^T f of one cluster, from its nodes or its children.
    /// @param zero     of type T, which has += and multiplication by a double on the left
    /// @param value    value(slot) of the field
    /// @param moments  [rank * clusters]: reads the children's, writes the cluster's
    template <typename T, typename Value>
    void gather(int level, int c, const T& zero, const Value& value, View<T> moments) const
    {
        const int id = tree_.first_of_level(level) + c;
        for (int r = 0; r < rank_; ++r)
            moments[rank_ * id + r] = view_.moment(level, c, r, zero, value, moments);
    }

private:
    template <int Rank>
    void fill(View<const EmbeddedPoint> points);

    const ClusterTree& tree_;
    int rank_;
    std::vector<double> leaves_, transfers_;
    BasisView<double> view_;
};

} // namespace toile
