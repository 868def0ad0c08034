#include "tests/core/shared_items.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

namespace toile::test {
namespace {

TEST(TurnOrder, HasEveryItemAtOnePlace)
{
    for (const int count : {0, 1, 31, 32, 33, 1000, 4097}) {
        const TurnOrder order{count};
        std::vector<int> found;
        for (int place = 0; place < order.place_count(); ++place)
            if (const int item = order.at(place); item < count) {
                EXPECT_EQ(order.place_of(item), place);
                found.push_back(item);
            }
        std::sort(found.begin(), found.end());
        ASSERT_EQ(int(found.size()), count);
        for (int i = 0; i < count; ++i)
            EXPECT_EQ(found[i], i);
    }
}

/// How many go one after the other at most where item i waits for all of i - reach to i + reach before it.
int longest_wait(const TurnOrder& order, int reach)
{
    std::vector<int> depth(order.count, 0);
    for (int place = 0; place < order.place_count(); ++place) {
        const int item = order.at(place);
        if (item >= order.count)
            continue;
        int before = 0;
        for (int other = std::max(0, item - reach); other <= std::min(order.count - 1, item + reach); ++other)
            before = std::max(before, depth[other]);
        depth[item] = before + 1;
    }
    return *std::max_element(depth.begin(), depth.end());
}

/// In the list's own order all would wait for each other.
TEST(TurnOrder, LetsNeighboursInAListGoSoon)
{
    const TurnOrder order{100000};
    EXPECT_LE(longest_wait(order, 1), 12);
    EXPECT_LE(longest_wait(order, 10), 64);
}

TEST(NumberTurn, CountsThoseBeforeInTheOrder)
{
    const SharedItems made(1000, 120);
    const TurnOrder order{1000};
    const std::vector<unsigned char> listed = some_listed(order);
    std::vector<int> places;
    std::vector<TurnRank> rank(4000, TurnRank(-1, false));
    std::vector<Vec3> values[] = {some_values(120, 1.0), some_values(120, 500.0)};
    std::vector<TaggedVector> passed(240, TaggedVector(Vec3::Zero(), -1));
    for (int place = 0; place < order.place_count(); ++place)
        if (listed[place] != 0)
            places.push_back(place);
    std::vector<int> count{int(places.size())};
    places.resize(order.place_count());
    const NumberTurn<SharedByItem, 2> number{
        {order, places, count, rank, passed, {}}, {made.items},           listed,
        {made.list_of, made.first, made.entries}, {values[0], values[1]}, rank};
    for (int q = 0; q < Turns::kShares * 1000; ++q)
        number(q);
    for (int shared = 0; shared < 120; ++shared) {
        std::vector<TurnRank> in_order;
        for (int place = 0; place < order.place_count(); ++place)
            for (int k = 0; listed[place] != 0 && k < Turns::kShares; ++k)
                if (const int item = order.at(place); made.items[item][k] == shared)
                    in_order.push_back(rank[Turns::kShares * item + k]);
        for (int before = 0; before < int(in_order.size()); ++before) {
            EXPECT_EQ(in_order[before].before(), before);
            EXPECT_EQ(in_order[before].is_last(), before + 1 == int(in_order.size()));
        }
        for (int f = 0; f < 2; ++f) {
            const TaggedVector& first = passed[120 * f + shared];
            EXPECT_EQ(first.turns(), in_order.empty() ? -1 : 0);
            EXPECT_EQ(first.value(), in_order.empty() ? Vec3(Vec3::Zero()) : values[f][shared]);
        }
    }
}

/// Either word alone tells that the vector is not there yet.
TEST(TaggedVector, IsWholeOnlyWithBothWords)
{
    const Vec3 value(-1.0 / 3.0, 1e300, -2.5e-310);
    const TaggedVector old(Vec3(7.0, 8.0, 9.0), 41), passed(value, 42);
    EXPECT_EQ(passed.turns(), 42);
    EXPECT_EQ(passed.value(), value);
    for (const int word : {0, 1}) {
        TaggedVector torn = old;
        torn.words[word] = passed.words[word];
        EXPECT_EQ(torn.turns(), 41);
    }
}

} // namespace
} // namespace toile::test
