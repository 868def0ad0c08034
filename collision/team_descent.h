#pragma once

#include "collision/implicit_box_tree.h"
#include "core/backend/cuda/team.h"

namespace toile {

/// A descent into an ImplicitBoxTree by a warp, for few queries: eight nodes at a time, their children side
/// by side. A thread alone waits for memory at every node.
struct TeamDescent {
    static constexpr int kNodes = kWarp / ImplicitShape::kFan; ///< whose children are looked at at a time
    /// Nodes to come. Those of a level are added when fewer than kNodes of it and below are there.
    static constexpr int kStack = kWarp + (kWarp - kNodes) * ImplicitShape::kMaxLevels;

    Team team;
    View<int> stack; ///< [kStack] of the team's

    /// Calls take(place, number, k), by any thread, for every item whose box overlaps the query's and k in
    /// [0, kTimes) for which accepts(number, k) is true; places count from 0, in the same order in every run.
    /// Returns how many there are. All threads of the team call it with the same arguments.
    template <int kTimes, typename Accepts, typename Take>
    TOILE_HD int visit(const ImplicitBoxTree& tree, const Box& query, const Accepts& accepts,
                       const Take& take) const
    {
        int size = 1, count = 0;
        if (team.thread == 0)
            stack[0] = entry(tree.shape.top, 0);
        while (size > 0) {
            team.wait();
            const int most = team.width() < kFan ? 1 : team.width() / kFan;
            const int opened = size < most ? size : most, parent = team.thread / kFan;
            size -= opened;
            const int above = parent < opened ? stack[size + parent] : entry(1, 0);
            const int level = above / kLevel - 1, first_child = above % kLevel * kFan;
            team.wait(); // until all have read what others write over
            for (int child = team.thread % kFan; child < kFan; child += team.width()) {
                const int node = first_child + child;
                const BoxNode own = tree.nodes[tree.shape.first[level] + node];
                const bool overlaps = parent < opened && own.box().overlaps(query);
                const Team::Flagged inner = team.flagged(overlaps && level > 0);
                if (overlaps && level > 0)
                    stack[size + inner.before] = entry(level, node);
                size += inner.count;
                for (int k = 0; k < kTimes; ++k) {
                    const bool is_taken = overlaps && level == 0 && accepts(own.last, k);
                    const Team::Flagged taken = team.flagged(is_taken);
                    if (is_taken)
                        take(count + taken.before, own.last, k);
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

} // namespace toile
