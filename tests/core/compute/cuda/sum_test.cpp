#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include "core/base/stages.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

using CudaParallelSum = OnDevice;

/// Numbers of very different magnitude and both signs, so that every order of summation rounds differently.
std::vector<double> rough_numbers(int count)
{
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> mantissa(-1.0, 1.0);
    std::uniform_int_distribution<int> exponent(-20, 20);
    std::vector<double> numbers(count);
    for (double& number : numbers)
        number = std::ldexp(mantissa(random), exponent(random));
    return numbers;
}

uint64_t bits(double value)
{
    uint64_t pattern = 0;
    std::memcpy(&pattern, &value, sizeof value);
    return pattern;
}

/// Max number of additions of a term: in its thread, in the tree, and both again for the block sums.
double depth(int count)
{
    const double blocks = std::ceil(count / 256.0);
    return 1.0 + 8.0 + std::ceil(blocks / 256.0) + 8.0;
}

TEST_F(CudaParallelSum, EqualsTheLongDoubleSumWithinRounding)
{
    SumScratch<double> scratch(space());
    for (const int count : {0, 1, 7, 255, 256, 257, 511, 512, 513, 4096, 1000000, 3000001}) {
        const std::vector<double> numbers = rough_numbers(count);
        DeviceArray<double> second(space(), "test/numbers");
        second.upload(numbers);
        long double exact = 0.0, magnitude = 0.0;
        for (const double number : numbers) {
            exact += number;
            magnitude += std::abs(number);
        }
        const double sum = sum_of(space(), second.view(), scratch);
        EXPECT_LE(std::abs(sum - exact), depth(count) * 0x1p-53 * magnitude) << count;
    }
}

/// Sum by a tree: pairs `width` apart, then half as far.
double tree_of(std::vector<double> partial)
{
    for (size_t width = partial.size() / 2; width > 0; width /= 2)
        for (size_t k = 0; k < width; ++k)
            partial[k] += partial[k + width];
    return partial[0];
}

/// Sum of one block of 256 threads over the numbers, by the trees drawn in parallel.cuh.
double block_sum(View<const double> numbers)
{
    std::vector<double> of_warp;
    for (int warp = 0; warp < 8; ++warp) {
        std::vector<double> partial(32, 0.0);
        for (int i = 0; i < numbers.size(); ++i)
            if (i % 256 / 32 == warp)
                partial[i % 32] += numbers[i];
        of_warp.push_back(tree_of(partial));
    }
    return tree_of(of_warp);
}

double tree_sum(View<const double> numbers)
{
    std::vector<double> sums;
    for (int first = 0; first < numbers.size(); first += 256)
        sums.push_back(block_sum(numbers.subview(first, std::min(256, numbers.size() - first))));
    return sums.size() == 1 ? sums[0] : block_sum(sums);
}

TEST_F(CudaParallelSum, HasTheBitsOfItsTreeEveryTime)
{
    const CudaSpace other(0);
    SumScratch<double> scratch(space()), other_scratch(other);
    for (const int count : {1, 256, 257, 512, 2049, 1000000}) {
        const std::vector<double> numbers = rough_numbers(count);
        const uint64_t expected = bits(tree_sum(numbers));
        DeviceArray<double> first(space(), "test/here"), second(other, "test/there");
        first.upload(numbers);
        second.upload(numbers);
        for (int i = 0; i < 20; ++i)
            ASSERT_EQ(bits(sum_of(space(), first.view(), scratch)), expected) << count << ", run " << i;
        EXPECT_EQ(bits(sum_of(other, second.view(), other_scratch)), expected) << count;
    }
}

TEST_F(CudaParallelSum, StaysOnTheDeviceForTheNextKernel)
{
    const std::vector<double> numbers = rough_numbers(50000);
    DeviceArray<double> second(space(), "test/numbers"), slot(space(), "test/slot", 1);
    DeviceArray<double> items(space(), "test/items"), block_sums(space(), "test/block_sums");
    second.upload(numbers);
    items.upload(std::vector<double>(3, 2.0));
    sum_into(space(), second.view(), slot.view(), block_sums);
    launch(space(), ScaleBySlot{slot.view(), items.view()});
    SumScratch<double> scratch(space());
    const double sum = sum_of(space(), second.view(), scratch);
    EXPECT_EQ(items.downloaded(), std::vector<double>(3, 2.0 * sum));
    EXPECT_EQ(slot.downloaded(), std::vector<double>(1, sum));
}

TEST_F(CudaParallelSum, IsZeroForNoItems)
{
    DeviceArray<double> slot(space(), "test/slot"), block_sums(space(), "test/block_sums");
    slot.upload(std::vector<double>(1, 5.0));
    sum_into(space(), View<const double>(), slot.view(), block_sums);
    EXPECT_EQ(slot.downloaded(), std::vector<double>(1, 0.0));
    SumScratch<double> scratch(space());
    EXPECT_EQ(sum_of(space(), View<const double>(), scratch), 0.0);
}

TEST_F(CudaParallelSum, AddsVectors)
{
    constexpr int kCount = 10000;
    std::vector<double> weight(kCount);
    std::vector<Vec3> point(kCount);
    Vec3 expected = Vec3::Zero();
    for (int i = 0; i < kCount; ++i) {
        weight[i] = 1 + i % 3;
        point[i] = Vec3(i, -2 * i, 1.0);
        expected += weight[i] * point[i]; // whole numbers: exact in any order
    }
    DeviceArray<double> weight_device(space(), "test/weight");
    DeviceArray<Vec3> point_device(space(), "test/point");
    weight_device.upload(weight);
    point_device.upload(point);
    SumScratch<Vec3> scratch(space());
    EXPECT_EQ(sum_of(space(), WeightedPoint{weight_device.view(), point_device.view()}, scratch), expected);
}

TEST_F(CudaParallelSum, AllocatesNothingOnceWarm)
{
    DeviceArray<double> numbers(space(), "test/numbers", 100000);
    numbers.fill_zero();
    SumScratch<double> scratch(space());
    sum_of(space(), numbers.view(), scratch);
    EXPECT_EQ(allocations_of([&] {
                  for (int i = 0; i < 10; ++i)
                      sum_of(space(), numbers.view(), scratch);
              }),
              0);
}

} // namespace
} // namespace toile::test
