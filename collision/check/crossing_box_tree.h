#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile::collision {

/// Tree of axis-aligned boxes in double precision that finds those meeting a box. It filters pairs for exact
/// predicates. Boxes of unrounded corners miss nothing, and touching boxes meet.
class CrossingBoxTree {
public:
    /// Builds the tree by splits at the median of the centres along the longest side. O(n log n).
    /// @param boxes  [boxes] empty ones (see Bounds) are never met
    explicit CrossingBoxTree(View<const Bounds> boxes);

    /// Appends the indices of boxes that meet `box`, in the tree's order, which depends on the boxes alone.
    void find(const Bounds& box, std::vector<int>& out) const;

private:
    struct Node {
        Bounds box;
        int first, count; ///< leaf: range in order_; inner node: count = 0 and first is its second child
    };

    void build(View<const Bounds> boxes, int first, int count);

    std::vector<Node> nodes_;   ///< depth first: the first child follows its parent
    std::vector<int> order_;    ///< boxes by leaf
    std::vector<Bounds> boxes_; ///< [order_] contiguous for the cache
};

/// True if the boxes share a point. Touching counts; an empty box meets nothing.
inline bool meet(const Bounds& a, const Bounds& b)
{
    return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

} // namespace toile::collision
