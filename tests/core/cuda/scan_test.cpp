#include "core/backend/cuda/scan.h"

#include <numeric>

#include "tests/core/cuda/on_device.h"

namespace toile::test {
namespace {

using ExclusiveSums = OnDevice;

TEST_F(ExclusiveSums, AreThoseOfTheStandardLibrary)
{
    DeviceArray<unsigned char> scratch(space(), "test/scratch");
    for (const int count : {0, 1, 2, 255, 4097, 1000003}) {
        std::vector<int> numbers(count), expected(count);
        for (int i = 0; i < count; ++i)
            numbers[i] = i * 7919 % 13;
        std::exclusive_scan(numbers.begin(), numbers.end(), expected.begin(), 0);
        DeviceArray<int> items(space(), "test/items"), sums(space(), "test/sums", count);
        items.upload(numbers);
        exclusive_sums(space(), "test/sums", items.view(), sums.view(), scratch);
        EXPECT_EQ(sums.downloaded(), expected) << count;
    }
}

TEST_F(ExclusiveSums, AskForMemoryOnce)
{
    DeviceArray<unsigned char> scratch(space(), "test/scratch");
    DeviceArray<int> items(space(), "test/items", 100000), sums(space(), "test/sums", 100000);
    items.fill_zero();
    exclusive_sums(space(), "test/sums", items.view(), sums.view(), scratch);
    EXPECT_EQ(
        allocations_of([&] { exclusive_sums(space(), "test/sums", items.view(), sums.view(), scratch); }), 0);
    space().synchronise();
}

} // namespace
} // namespace toile::test
