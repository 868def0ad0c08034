#pragma once

#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace toile {

/// Axis-aligned boxes in double precision, to be asked which of them a box meets. The filter in front of
/// exact predicates: a box of corners as they are leaves nothing out, touching boxes meet.
class BoxTree {
public:
    /// Splits by the median of the centres along the longest side. O(n log n).
    /// @param boxes  [boxes] empty ones (see Bounds) are never met
    explicit BoxTree(View<const Bounds> boxes);

    /// Appends the indices of boxes that meet `box`, in the tree's order, which depends on the boxes alone.
    void find(const Bounds& box, std::vector<int>& out) const;

private:
    struct Node {
        Bounds box;
        int first, count; ///< of a leaf: in order_; of an inner node count = 0 and first is its second child
    };

    void build(View<const Bounds> boxes, int first, int count);

    std::vector<Node> nodes_;   ///< depth first: the first child follows its parent
    std::vector<int> order_;    ///< boxes by leaf
    std::vector<Bounds> boxes_; ///< [order_] side by side for the cache
};

/// Touching counts; an empty box meets nothing.
inline bool meet(const Bounds& a, const Bounds& b)
{
    return (a.lower.array() <= b.upper.array()).all() && (b.lower.array() <= a.upper.array()).all();
}

} // namespace toile
