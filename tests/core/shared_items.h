#pragma once

#include <array>
#include <random>
#include <vector>

#include "core/backend/turns.h"

namespace toile::test {

/// Mixes what an item shares, and its own number: another order is another result.
struct MixShared {
    View<const std::array<int, Turns::kShares>> items;
    View<double> values; ///< [shared]

    TOILE_HD int prepare(int item) const { return item; }
    TOILE_HD std::array<int, Turns::kShares> shared(int item) const { return items[item]; }
    TOILE_HD void operator()(int item, int own) const
    {
        double sum = 1.0 + own;
        for (const int at : items[item])
            sum = at >= 0 ? 0.5 * (sum + values[at]) : sum;
        for (const int at : items[item])
            if (at >= 0)
                values[at] = 0.5 * (values[at] - sum);
    }
};

/// What items share.
struct SharedByItem {
    View<const std::array<int, Turns::kShares>> items;
    TOILE_HD std::array<int, Turns::kShares> operator()(int item) const { return items[item]; }
};

/// Items that share one to four things with their neighbours in the list; every seventeenth shares the last
/// thing too.
struct SharedItems {
    SharedItems(int count, int shared_count) : items(count), list_of(shared_count)
    {
        std::mt19937 random(3);
        std::vector<std::vector<int>> of_shared(shared_count);
        for (int i = 0; i < count; ++i) {
            items[i].fill(-1);
            const int start = int(std::int64_t(i) * (shared_count - 9) / count);
            const int used = i % 17 == 0 ? Turns::kShares : 1 + i % Turns::kShares;
            for (int k = 0; k < used; ++k)
                items[i][k] = i % 17 == 0 && k == 3 ? shared_count - 1 : start + 2 * k + int(random() % 2);
            for (int k = 0; k < used; ++k)
                of_shared[items[i][k]].push_back(Turns::kShares * i + k);
        }
        for (int s = shared_count - 1; s >= 0; --s) {
            list_of[s] = shared_count - s;
            entries.insert(entries.end(), of_shared[s].begin(), of_shared[s].end());
            first.push_back(int(entries.size()));
        }
    }

    std::vector<std::array<int, Turns::kShares>> items;
    std::vector<int> list_of, first{0}, entries; ///< see SharedLists
};

/// Every third item, and the first.
inline std::vector<unsigned char> some_listed(const TurnOrder& order)
{
    std::vector<unsigned char> listed(order.place_count(), 0);
    for (int i = 0; i < order.count; i += 3)
        listed[order.place_of(i)] = 1;
    return listed;
}

/// What the listed ones make of `values`, one after the other.
inline void mix_in_turn(const SharedItems& made, const TurnOrder& order,
                        const std::vector<unsigned char>& listed, std::vector<double>& values)
{
    const MixShared mix{made.items, values};
    for (int place = 0; place < order.place_count(); ++place)
        if (listed[place] != 0)
            mix(order.at(place), order.at(place));
}

} // namespace toile::test
