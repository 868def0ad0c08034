#pragma once

#include <array>
#include <random>
#include <vector>

#include "core/compute/gauss_seidel.h"

namespace toile::test {

/// Mixes the shared values of an item with its number: another order gives another result.
struct MixShared {
    static constexpr int kFields = 2;

    View<const std::array<int, GaussSeidelState::kSharedSlots>> items;
    SharedFields<2> values; ///< [shared]

    TOILE_HD SharedFields<2> fields() const { return values; }
    TOILE_HD int prepare(int item) const { return item; }
    TOILE_HD std::array<int, GaussSeidelState::kSharedSlots> shared(int item) const { return items[item]; }
    TOILE_HD void operator()(int item, int prepared, LocalFields<2>& local) const
    {
        Vec3 sum(1.0 + prepared, 0.5 * prepared, 2.0);
        for (int k = 0; k < GaussSeidelState::kSharedSlots; ++k)
            if (items[item][k] >= 0)
                sum = 0.5 * (sum + local[0][k] - 0.25 * local[1][k]);
        for (int k = 0; k < GaussSeidelState::kSharedSlots; ++k)
            if (items[item][k] >= 0) {
                local[0][k] = 0.5 * (local[0][k] - sum);
                local[1][k] = 0.5 * (local[1][k] + local[0][k]);
            }
    }
};

/// Shared slots of each item.
struct SharedByItem {
    View<const std::array<int, GaussSeidelState::kSharedSlots>> items;
    TOILE_HD std::array<int, GaussSeidelState::kSharedSlots> operator()(int item) const
    {
        return items[item];
    }
};

/// Items that share one to four slots with their neighbours in the list. Every seventeenth shares the last
/// slot too.
struct SharedItems {
    SharedItems(int count, int shared_count) : items(count), list_of(shared_count)
    {
        std::mt19937 random(3);
        std::vector<std::vector<int>> of_shared(shared_count);
        for (int i = 0; i < count; ++i) {
            items[i].fill(-1);
            const int start = int(std::int64_t(i) * (shared_count - 9) / count);
            const int used =
                i % 17 == 0 ? GaussSeidelState::kSharedSlots : 1 + i % GaussSeidelState::kSharedSlots;
            for (int k = 0; k < used; ++k)
                items[i][k] = i % 17 == 0 && k == 3 ? shared_count - 1 : start + 2 * k + int(random() % 2);
            for (int k = 0; k < used; ++k)
                of_shared[items[i][k]].push_back(GaussSeidelState::kSharedSlots * i + k);
        }
        for (int s = shared_count - 1; s >= 0; --s) {
            list_of[s] = shared_count - s;
            entries.insert(entries.end(), of_shared[s].begin(), of_shared[s].end());
            first.push_back(int(entries.size()));
        }
    }

    std::vector<std::array<int, GaussSeidelState::kSharedSlots>> items;
    std::vector<int> list_of, first{0}, entries; ///< see SharedLists
};

/// Flags of every third item, starting with the first.
inline std::vector<unsigned char> some_listed(const GaussSeidelSchedule& order)
{
    std::vector<unsigned char> listed(order.slot_count(), 0);
    for (int i = 0; i < order.count; i += 3)
        listed[order.slot_of(i)] = 1;
    return listed;
}

/// Result of the listed items on `values` [shared], one after the other.
inline void mix_sequentially(const SharedItems& made, const GaussSeidelSchedule& order,
                             const std::vector<unsigned char>& listed, const SharedFields<2>& values)
{
    const MixShared mix{made.items, values};
    for (int slot = 0; slot < order.slot_count(); ++slot) {
        if (listed[slot] == 0)
            continue;
        const int item = order.at(slot);
        LocalFields<2> local;
        const auto each = [&](const auto& exchange) {
            for (int f = 0; f < 2; ++f)
                for (int k = 0; k < GaussSeidelState::kSharedSlots; ++k)
                    if (made.items[item][k] >= 0)
                        exchange(local[f][k], values[f][made.items[item][k]]);
        };
        each([](Vec3& local_value, const Vec3& shared_value) { local_value = shared_value; });
        mix(item, item, local);
        each([](const Vec3& local_value, Vec3& shared_value) { shared_value = local_value; });
    }
}

/// Distinct values.
inline std::vector<Vec3> some_values(int count, double first)
{
    std::vector<Vec3> values;
    values.reserve(count);
    for (int i = 0; i < count; ++i)
        values.emplace_back(first + i, -0.25 * i, 1.0 / (i + first));
    return values;
}

} // namespace toile::test
