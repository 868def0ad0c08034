#pragma once

#include <array>
#include <vector>

#include "collision/bvh/box_block.h"
#include "core/compute/types.h"
#include "core/mesh/topology.h"

namespace toile::collision {

/// Binary tree of boxes over moving items. build() fixes its topology once; refit() updates the boxes.
class BoxTree {
public:
    /// Maximum number of items per leaf: one block of lanes.
    static constexpr int kLeafItems = BoxBlock::kCount;

    struct Node {
        Box box;
        int child = -1;        ///< first of two adjacent children, which come later in the list; -1: a leaf
        int leaf = -1;         ///< number of the leaf, or -1
        bool is_wanted = true; ///< contains a wanted item; pairs of two unwanted nodes are skipped
    };
    /// Two overlapping nodes whose leaves are tested against each other; both entries may name the same node.
    using NodePair = std::array<int, 2>;

    /// Builds the topology: splits at the minimum of surface times blocks of items over 16 planes across the
    /// longest axis (binned surface area heuristic [Wald 2007]). O(n log n).
    void build(View<const Box> items);

    int leaf_count() const { return int(leaves_.first.size()) - 1; }
    View<const int> items_of(int leaf) const { return leaves_.of(leaf); }

    /// Refits all boxes from the leaves' boxes. O(n).
    /// @param wanted  [leaves] Node::is_wanted
    void refit(View<const Box> leaf_boxes, View<const unsigned char> wanted);

    /// Sum of the nodes' half surfaces [m^2], each box shrunk by `shrink` [m]. It grows as motion degrades
    /// the tree.
    double surface(float shrink) const;

    const std::vector<Node>& nodes() const { return nodes_; }

    /// Opens the pair (root, root) level by level until `count` pairs of overlapping nodes exist or only
    /// leaves are left. Replaces the content of out.
    void pairs_of_nodes(int count, std::vector<NodePair>& out) const;

    /// Calls meet(leaf_node_a, leaf_node_b) for every two overlapping leaves below a pair, including a == b.
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

    /// Calls visit for the pairs one level below: three for a node with itself, else two from the larger
    /// node.
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

} // namespace toile::collision
