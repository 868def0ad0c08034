#pragma once

#include "collision/bvh/implicit_box_tree.h"
#include "core/compute/team.h"

namespace toile::collision {

/// Descent into an ImplicitBoxTree by a warp, for few queries. Eight nodes are opened at a time, their
/// children side by side; a single thread would wait for memory at every node.
struct TeamDescent {
    static constexpr int kNodes = kWarp / ImplicitShape::kFan; ///< nodes opened at a time
    /// Capacity of the stack of nodes to visit. Nodes of a level are pushed only while the stack holds fewer
    /// than kNodes of that level and below.
    static constexpr int kStack = kWarp + (kWarp - kNodes) * ImplicitShape::kMaxLevels;

    Team team;
    View<int> stack; ///< [kStack] shared by the team

    /// Calls take(slot, number, k) for every item whose box overlaps the query's and every k in [0, kTimes)
    /// with accepts(number, k). Any thread may make the call. Slots count from 0, in the same order in every
    /// run. All threads of the team call visit with the same arguments.
    /// @return number of accepted calls
    template <int kTimes, typename Accepts, typename Take>
    TOILE_HD int visit(const ImplicitBoxTree& tree, const Box& query, const Accepts& accepts,
                       const Take& take) const
    {
        int size = 1, count = 0;
        if (team.thread == 0)
            stack[0] = entry(tree.shape.top, 0);
        while (size > 0) {
            team.wait();
            const int max_opened = team.width() < kFan ? 1 : team.width() / kFan;
            const int opened = size < max_opened ? size : max_opened, parent = team.thread / kFan;
            size -= opened;
            const int above = parent < opened ? stack[size + parent] : entry(1, 0);
            const int level = above / kLevel - 1, first_child = above % kLevel * kFan;
            team.wait(); // all threads have read the entries that are overwritten below
            for (int child = team.thread % kFan; child < kFan; child += team.width()) {
                const int node = first_child + child;
                const BoxNode box_node = tree.nodes[tree.shape.first[level] + node];
                const bool overlaps = parent < opened && box_node.box().overlaps(query);
                const Team::Flagged inner = team.flagged(overlaps && level > 0);
                if (overlaps && level > 0)
                    stack[size + inner.before] = entry(level, node);
                size += inner.count;
                for (int k = 0; k < kTimes; ++k) {
                    const bool is_taken = overlaps && level == 0 && accepts(box_node.last, k);
                    const Team::Flagged taken = team.flagged(is_taken);
                    if (is_taken)
                        take(count + taken.before, box_node.last, k);
                    count += taken.count;
                }
            }
        }
        return count;
    }

private:
    static constexpr int kFan = ImplicitShape::kFan;
    static constexpr int kLevel = 1 << 27; ///< more nodes than a level has
    static_assert(ImplicitShape::kMaxLevels * long(kLevel) <= 1L << 31);

    TOILE_HD static int entry(int level, int node) { return level * kLevel + node; }
};

} // namespace toile::collision
