#pragma once

#include <array>
#include <vector>

#include "collision/box_block.h"
#include "core/backend/types.h"
#include "core/mesh/topology.h"

namespace toile {

/// A binary tree of boxes over items that move: its shape is chosen once, its boxes are renewed.
class BoxTree {
public:
    /// Items per leaf, at most: what one block of lanes holds.
    static constexpr int kLeafItems = BoxBlock::kCount;

    struct Node {
        Box box;
        int child = -1;        ///< the first of two neighbours, which come later in the list; -1: a leaf
        int leaf = -1;         ///< number of the leaf, or -1
        bool is_wanted = true; ///< pairs of two nodes that are not are left out
    };
    /// Two nodes, or twice the same one, whose leaves are to be met with each other.
    using NodePair = std::array<int, 2>;

    /// Chooses the shape: splits where the sum of surface times blocks of items is least, among 16 planes
    /// across the longest axis (binned surface area heuristic [Wald 2007]). O(n log n).
    void build(View<const Box> items);

    int leaf_count() const { return int(leaves_.first.size()) - 1; }
    View<const int> items_of(int leaf) const { return leaves_.of(leaf); }

    /// Renews all boxes from those of the leaves. O(n).
    /// @param wanted  [leaves] Node::is_wanted
    void refit(View<const Box> leaf_boxes, View<const unsigned char> wanted);

    /// Sum of the nodes' half surfaces [m^2], each box shrunk by `shrink` [m]: grows as the shape goes bad.
    double surface(float shrink) const;

    const std::vector<Node>& nodes() const { return nodes_; }

    /// Opens the tree's pair with itself, level by level, until there are `count` pairs of nodes that overlap
    /// or only leaves are left. Replaces the content of out.
    void pairs_of_nodes(int count, std::vector<NodePair>& out) const;

    /// Calls meet(leaf_node_a, leaf_node_b) for every two overlapping leaves below a pair, a == b included.
    template <typename Meet>
    void descend(NodePair pair, const Meet& meet) const
    {
        if (!may_meet(pair))
            return;
        const Node &a = nodes_[pair[0]], &b = nodes_[pair[1]];
        if (a.child < 0 && b.child < 0)
            return meet(a, b);
        open(pair, [&](NodePair below) { descend(below, meet); });
    }

private:
    bool may_meet(NodePair pair) const
    {
        const Node &a = nodes_[pair[0]], &b = nodes_[pair[1]];
        return (a.is_wanted || b.is_wanted) && (pair[0] == pair[1] || a.box.overlaps(b.box));
    }

    /// Calls visit for the pairs one level below: the three of a node with itself, else the larger is opened.
    template <typename Visit>
    void open(NodePair pair, const Visit& visit) const
    {
        const auto [a, b] = pair;
        const Node &node_a = nodes_[a], &node_b = nodes_[b];
        if (a == b) {
            visit(NodePair{node_a.child, node_a.child});
            visit(NodePair{node_a.child, node_a.child + 1});
            visit(NodePair{node_a.child + 1, node_a.child + 1});
        } else if (node_b.child < 0 || (node_a.child >= 0 && node_a.box.size() >= node_b.box.size())) {
            visit(NodePair{node_a.child, b});
            visit(NodePair{node_a.child + 1, b});
        } else {
            visit(NodePair{a, node_b.child});
            visit(NodePair{a, node_b.child + 1});
        }
    }

    std::vector<Node> nodes_;   ///< root first
    Incidence leaves_{{0}, {}}; ///< items per leaf
};

} // namespace toile
