#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/assert.h"

namespace toile {

/// Items that belong to pairs of vertices, such as the sides of triangles, listed by pair. A pair (i, j), i <
/// j, has two entries in a Hessian, to which one thread adds all of its items.
struct PairLists {
    std::vector<std::array<int, 2>> positions; ///< [pairs] of the entries (i, j), ascending, and (j, i)
    std::vector<int> first{0};                 ///< [pairs + 1] into items
    std::vector<int> items;                    ///< 2 * item, plus 1 if the item's own pair is (j, i)

    /// O(items log items).
    /// @param pair_of_item  [items] two different vertices
    /// @param position      (i, j) -> the position of this entry
    template <typename Position>
    PairLists(const std::vector<std::array<int, 2>>& pair_of_item, const Position& position)
    {
        std::vector<std::array<int, 2>> sorted; // position of (i, j), and the item as above
        for (int k = 0; k < int(pair_of_item.size()); ++k) {
            const auto [a, b] = pair_of_item[k];
            sorted.push_back({position(std::min(a, b), std::max(a, b)), 2 * k + (a > b ? 1 : 0)});
            TOILE_ASSERT(sorted.back()[0] >= 0);
        }
        std::sort(sorted.begin(), sorted.end());

        for (const auto& [at, item] : sorted) {
            if (positions.empty() || at != positions.back()[0]) {
                if (!items.empty())
                    first.push_back(int(items.size()));
                const auto [a, b] = pair_of_item[item / 2];
                positions.push_back({at, position(std::max(a, b), std::min(a, b))});
                TOILE_ASSERT(positions.back()[1] >= 0);
            }
            items.push_back(item);
        }
        if (!items.empty())
            first.push_back(int(items.size()));
    }
};

} // namespace toile
