#include "tests/core/compute/shared_items.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace toile::test {
namespace {

TEST(GaussSeidelSchedule, HasEveryItemInOneSlot)
{
    for (const int count : {0, 1, 31, 32, 33, 1000, 4097}) {
        const GaussSeidelSchedule order{count};
        std::vector<int> found;
        for (int slot = 0; slot < order.slot_count(); ++slot)
            if (const int item = order.at(slot); item < count) {
                EXPECT_EQ(order.slot_of(item), slot);
                found.push_back(item);
            }
        std::sort(found.begin(), found.end());
        ASSERT_EQ(int(found.size()), count);
        for (int i = 0; i < count; ++i)
            EXPECT_EQ(found[i], i);
    }
}

/// Length of the longest dependency chain if item i depends on items i - reach to i + reach before it.
int longest_wait(const GaussSeidelSchedule& order, int reach)
{
    std::vector<int> depth(order.count, 0);
    for (int slot = 0; slot < order.slot_count(); ++slot) {
        const int item = order.at(slot);
        if (item >= order.count)
            continue;
        int before = 0;
        for (int other = std::max(0, item - reach); other <= std::min(order.count - 1, item + reach); ++other)
            before = std::max(before, depth[other]);
        depth[item] = before + 1;
    }
    return *std::max_element(depth.begin(), depth.end());
}

/// In the order of the list all items would form one chain.
TEST(GaussSeidelSchedule, KeepsDependencyChainsOfListNeighboursShort)
{
    const GaussSeidelSchedule order{100000};
    EXPECT_LE(longest_wait(order, 1), 12);
    EXPECT_LE(longest_wait(order, 10), 64);
}

TEST(AssignGaussSeidelRank, CountsItemsBeforeInTheSchedule)
{
    const SharedItems made(1000, 120);
    const GaussSeidelSchedule order{1000};
    const std::vector<unsigned char> listed = some_listed(order);
    std::vector<int> slots;
    std::vector<GaussSeidelRank> rank(4000, GaussSeidelRank(-1, false));
    std::vector<Vec3> values[] = {some_values(120, 1.0), some_values(120, 500.0)};
    std::vector<TaggedVector> passed(240, TaggedVector(Vec3::Zero(), -1));
    for (int slot = 0; slot < order.slot_count(); ++slot)
        if (listed[slot] != 0)
            slots.push_back(slot);
    std::vector<int> count{int(slots.size())};
    slots.resize(order.slot_count());
    const AssignGaussSeidelRank<SharedByItem, 2> number{
        {order, slots, count, rank, passed, {}},  {made.items},           listed,
        {made.list_of, made.first, made.entries}, {values[0], values[1]}, rank};
    for (int q = 0; q < GaussSeidelState::kSharedSlots * 1000; ++q)
        number(q);
    for (int shared = 0; shared < 120; ++shared) {
        std::vector<GaussSeidelRank> in_order;
        for (int slot = 0; slot < order.slot_count(); ++slot)
            for (int k = 0; listed[slot] != 0 && k < GaussSeidelState::kSharedSlots; ++k)
                if (const int item = order.at(slot); made.items[item][k] == shared)
                    in_order.push_back(rank[GaussSeidelState::kSharedSlots * item + k]);
        for (int before = 0; before < int(in_order.size()); ++before) {
            EXPECT_EQ(in_order[before].before(), before);
            EXPECT_EQ(in_order[before].is_last(), before + 1 == int(in_order.size()));
        }
        for (int f = 0; f < 2; ++f) {
            const TaggedVector& first = passed[120 * f + shared];
            EXPECT_EQ(first.version(), in_order.empty() ? -1 : 0);
            EXPECT_EQ(first.value(), in_order.empty() ? Vec3(Vec3::Zero()) : values[f][shared]);
        }
    }
}

/// Either word alone shows that the vector is incomplete.
TEST(TaggedVector, IsCompleteOnlyWithBothWords)
{
    const Vec3 value(-1.0 / 3.0, 1e300, -2.5e-310);
    const TaggedVector old(Vec3(7.0, 8.0, 9.0), 41), passed(value, 42);
    EXPECT_EQ(passed.version(), 42);
    EXPECT_EQ(passed.value(), value);
    for (const int word : {0, 1}) {
        TaggedVector torn = old;
        torn.words[word] = passed.words[word];
        EXPECT_EQ(torn.version(), 41);
    }
}

} // namespace
} // namespace toile::test
