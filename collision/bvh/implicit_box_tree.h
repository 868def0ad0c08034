#pragma once

#include <array>
#include <cstdint>

#include "collision/bvh/box.h"
#include "core/compute/bits.h"
#include "core/compute/implicit_tree.h"
#include "core/compute/shared_bounds.h"

namespace toile::collision {

/// Node of an ImplicitBoxTree: 32 bytes, two loads of a GPU. Empty at first.
struct alignas(16) BoxNode {
    std::array<float, 3> lower{Box::kFar, Box::kFar, Box::kFar}; ///< [m]
    int last = -1;                                               ///< largest number of an item below
    std::array<float, 3> upper{-Box::kFar, -Box::kFar, -Box::kFar};
    int is_wanted = 0; ///< 1: contains a wanted item; pairs of two unwanted nodes are skipped

    TOILE_HD static BoxNode of_item(const Box& box, int number, bool is_wanted)
    {
        return {box.lower, number, box.upper, int(is_wanted)};
    }
    TOILE_HD Box box() const { return {lower, upper}; }

    TOILE_HD void add(const BoxNode& other)
    {
        for (int k = 0; k < 3; ++k) {
            lower[k] = std::min(lower[k], other.lower[k]);
            upper[k] = std::max(upper[k], other.upper[k]);
        }
        last = std::max(last, other.last);
        is_wanted |= other.is_wanted;
    }

    TOILE_HD bool contains(const BoxNode& other) const
    {
        bool all = true;
        for (int k = 0; k < 3; ++k)
            all &= lower[k] <= other.lower[k] && other.upper[k] <= upper[k];
        return all;
    }
    /// Extends the box by another while other threads extend it too.
    TOILE_HD void grow_shared(const BoxNode& other)
    {
        for (int k = 0; k < 3; ++k) {
            lower_shared(lower[k], other.lower[k]);
            raise_shared(upper[k], other.upper[k]);
        }
    }
};

/// Layout of a tree with four children per node and no pointers. Node c has the children 4c .. 4c + 3 of the
/// level below, as far as they exist; level 0 holds the items in the tree's order. Levels begin at multiples
/// of four, so that four children share one cache line.
struct ImplicitShape {
    static constexpr int kFan = 4, kFanBits = 2;
    static constexpr int kMaxLevels = 16; ///< 4^15 items

    int count = 0;                           ///< items
    int top = 0;                             ///< level of the root; at least 1
    std::array<int, kMaxLevels + 1> first{}; ///< [top + 2] number of nodes before a level

    explicit ImplicitShape(int items) : count(items)
    {
        do {
            first[top + 1] = first[top] + (size_of(top) + kFan - 1) / kFan * kFan;
            ++top;
        } while (size_of(top) > 1);
        first[top + 1] = first[top] + kFan;
    }

    /// Number of nodes of a level; 0 without items.
    TOILE_HD int size_of(int level) const { return level_size(count, kFanBits * level); }
    int node_count() const { return first[top + 1]; }
};

/// Tree of boxes over moving items, in an order chosen once (see ImplicitShape).
struct ImplicitBoxTree {
    ImplicitShape shape;
    View<const BoxNode> nodes; ///< [ImplicitShape::node_count()] empty boxes at unused indices

    /// Calls visit(number) for items with a number above `above` whose boxes overlap the query's, in the
    /// tree's order. A query that is not wanted visits wanted items only.
    template <typename Visit>
    TOILE_HD void visit_overlapping(const BoxNode& query, int above, const Visit& visit) const
    {
        const auto is_open = [&](const BoxNode& node) {
            return (node.last > above) & ((node.is_wanted | query.is_wanted) != 0) &
                   node.box().overlaps(query.box());
        };
        descend(is_open, visit);
    }

    /// Calls visit(number), in the tree's order, for items with is_open(node) whose ancestors are open too.
    /// Nodes may close while items are visited; they may not open.
    template <typename IsOpen, typename Visit>
    TOILE_HD void descend(const IsOpen& is_open, const Visit& visit) const
    {
        // Four bits per level: children still to be visited, lower levels first.
        int level = shape.top - 1, base = 0;
        std::uint64_t open = open_ones(is_open, level, base);
        open <<= ImplicitShape::kFan * level;
        while (open != 0) {
            const int bit = lowest_bit(open);
            open &= open - 1;
            const int above_last = bit / ImplicitShape::kFan - level;
            base = base >> (ImplicitShape::kFanBits * above_last) & ~(ImplicitShape::kFan - 1);
            level += above_last;
            const int node = base + bit % ImplicitShape::kFan;
            if (level == 0) {
                visit(nodes[node].last);
                continue;
            }
            --level;
            base = node * ImplicitShape::kFan;
            open |= std::uint64_t(open_ones(is_open, level, base)) << (ImplicitShape::kFan * level);
        }
    }

    /// Item reached from the root by always descending into the child of minimum cost(node); -1 in an empty
    /// tree.
    template <typename Cost>
    TOILE_HD int greedy_item(const Cost& cost) const
    {
        int node = 0;
        for (int level = shape.top - 1; level >= 0; --level) {
            const int base = ImplicitShape::kFan * node;
            node = base;
            for (int k = 1; k < ImplicitShape::kFan; ++k)
                if (cost(nodes[shape.first[level] + base + k]) < cost(nodes[shape.first[level] + node]))
                    node = base + k;
        }
        return nodes[node].last;
    }

private:
    /// Bit mask of is_open for the four nodes from `base` on.
    template <typename IsOpen>
    TOILE_HD unsigned open_ones(const IsOpen& is_open, int level, int base) const
    {
        unsigned bits = 0;
        for (int k = 0; k < ImplicitShape::kFan; ++k) {
            const BoxNode node = nodes[shape.first[level] + base + k];
            bits |= unsigned(is_open(node)) << k;
        }
        return bits;
    }
};

} // namespace toile::collision
