#pragma once

#include <array>
#include <random>
#include <vector>

#include "core/backend/turns.h"

namespace toile::test {

/// Mixes what an item shares, and its own number: another order is another result.
struct MixShared {
    static constexpr int kFields = 2;

    View<const std::array<int, Turns::kShares>> items;
    SharedFields<2> values; ///< [shared]

    TOILE_HD SharedFields<2> fields() const { return values; }
    TOILE_HD int prepare(int item) const { return item; }
    TOILE_HD std::array<int, Turns::kShares> shared(int item) const { return items[item]; }
    TOILE_HD void operator()(int item, int prepared, OwnFields<2>& own) const
    {
        Vec3 sum(1.0 + prepared, 0.5 * prepared, 2.0);
        for (int k = 0; k < Turns::kShares; ++k)
            if (items[item][k] >= 0)
                sum = 0.5 * (sum + own[0][k] - 0.25 * own[1][k]);
        for (int k = 0; k < Turns::kShares; ++k)
            if (items[item][k] >= 0) {
                own[0][k] = 0.5 * (own[0][k] - sum);
                own[1][k] = 0.5 * (own[1][k] + own[0][k]);
            }
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

/// What the listed ones make of `values` [shared], one after the other.
inline void mix_in_turn(const SharedItems& made, const TurnOrder& order,
                        const std::vector<unsigned char>& listed, const SharedFields<2>& values)
{
    const MixShared mix{made.items, values};
    for (int place = 0; place < order.place_count(); ++place) {
        if (listed[place] == 0)
            continue;
        const int item = order.at(place);
        OwnFields<2> own;
        const auto each = [&](const auto& exchange) {
            for (int f = 0; f < 2; ++f)
                for (int k = 0; k < Turns::kShares; ++k)
                    if (made.items[item][k] >= 0)
                        exchange(own[f][k], values[f][made.items[item][k]]);
        };
        each([](Vec3& here, const Vec3& there) { here = there; });
        mix(item, item, own);
        each([](const Vec3& here, Vec3& there) { there = here; });
    }
}

/// Values that all differ.
inline std::vector<Vec3> some_values(int count, double first)
{
    std::vector<Vec3> values;
    values.reserve(count);
    for (int i = 0; i < count; ++i)
        values.emplace_back(first + i, -0.25 * i, 1.0 / (i + first));
    return values;
}

} // namespace toile::test
