#include <algorithm>
#include <numeric>
#include <random>

#include "core/compute/cuda/sort.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {
namespace {

const std::vector<int> kCounts{0, 1, 31, 1000, 1000003};

using CudaLists = OnDevice;

TEST_F(CudaLists, ExclusiveScanSumsThePrecedingItems)
{
    DeviceScratch scratch(space(), "test/scratch");
    for (const int count : kCounts) {
        std::vector<int> numbers(count);
        for (int i = 0; i < count; ++i)
            numbers[i] = i % 10 == 0 ? 2000000 : i % 7; // the largest sum is beyond int
        std::vector<long> expected(count);
        std::exclusive_scan(numbers.begin(), numbers.end(), expected.begin(), 0L);
        DeviceArray<int> counts(space(), "test/counts");
        DeviceArray<long> first(space(), "test/first", count);
        counts.upload(numbers);
        exclusive_scan(space(), "test/scan", counts.view(), first.view(), scratch);
        EXPECT_EQ(first.downloaded(), expected) << count;
    }
}

TEST_F(CudaLists, ListFlaggedKeepsTheOrder)
{
    DeviceScratch scratch(space(), "test/scratch");
    std::mt19937 random(1);
    for (const int length : kCounts) {
        std::vector<unsigned char> flags(length);
        std::vector<int> expected;
        for (int i = 0; i < length; ++i) {
            flags[i] = random() % 3 == 0 ? 1 : 0;
            if (flags[i] != 0)
                expected.push_back(i);
        }
        DeviceArray<unsigned char> on_device(space(), "test/flags");
        on_device.upload(flags);
        DeviceArray<int> indices(space(), "test/places", length), count(space(), "test/count", 1);
        count.fill_zero();
        list_flagged(space(), "test/list", on_device.view(), indices.view(), count.view(), scratch);
        std::vector<int> found = indices.downloaded();
        ASSERT_EQ(count.downloaded()[0], int(expected.size())) << length;
        found.resize(expected.size());
        EXPECT_EQ(found, expected) << length;
    }
}

TEST_F(CudaLists, SortByKeyIsStable)
{
    SortArrays arrays(space());
    std::mt19937_64 random(2);
    for (const int count : kCounts) {
        std::vector<std::uint64_t> keys(count);
        for (std::uint64_t& key : keys)
            key = random() >> (random() % 2 == 0 ? 1 : 60);
        std::vector<int> values(count);
        std::iota(values.begin(), values.end(), 0);
        arrays.keys.upload(keys);
        arrays.sorted_keys.resize(count);
        arrays.values.upload(values);
        DeviceArray<int> sorted(space(), "test/sorted", count);
        sort_by_key(space(), "test/sort", arrays, sorted.view());
        std::stable_sort(values.begin(), values.end(), [&](int a, int b) { return keys[a] < keys[b]; });
        EXPECT_EQ(sorted.downloaded(), values) << count;
    }
}

TEST_F(CudaLists, SortByKeyUsesOnlyTheGivenBits)
{
    // Numbers below a count, and all ones, which sort after them.
    SortArrays arrays(space());
    std::mt19937 random(2);
    for (const int below : {1, 31, 32, 1000}) {
        std::vector<std::uint64_t> keys(5000);
        for (std::uint64_t& key : keys)
            key = random() % 4 == 0 ? ~std::uint64_t(0) : random() % below;
        std::vector<int> values(keys.size());
        std::iota(values.begin(), values.end(), 0);
        arrays.keys.upload(keys);
        arrays.sorted_keys.resize(int(keys.size()));
        arrays.values.upload(values);
        DeviceArray<int> sorted(space(), "test/sorted", int(keys.size()));
        sort_by_key(space(), "test/sort", arrays, sorted.view(), key_bits(below));
        std::stable_sort(values.begin(), values.end(), [&](int a, int b) { return keys[a] < keys[b]; });
        EXPECT_EQ(sorted.downloaded(), values) << below;
    }
}

} // namespace
} // namespace toile::test
