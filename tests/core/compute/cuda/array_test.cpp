#include "core/compute/cuda/array.h"

#include <iostream>
#include <numeric>

#include "core/base/error.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

using DeviceArrayTest = OnDevice;
using PinnedArrayTest = OnDevice;

std::vector<int> counting(int count)
{
    std::vector<int> numbers(count);
    std::iota(numbers.begin(), numbers.end(), 1);
    return numbers;
}

TEST_F(DeviceArrayTest, RoundTripsItsContent)
{
    std::vector<Vec3> points;
    std::vector<Mat2> matrices;
    for (int i = 0; i < 1000; ++i) {
        points.emplace_back(i, 0.1 * i, -1.0 / (i + 1));
        matrices.push_back(Mat2::Constant(0.3 * i));
        matrices.back()(0, 1) = 7.0;
    }
    DeviceArray<Vec3> points_device(space(), "test/points");
    DeviceArray<Mat2> matrices_device(space(), "test/matrices");
    points_device.upload(points);
    matrices_device.upload(matrices);
    EXPECT_EQ(points_device.downloaded(), points);
    EXPECT_EQ(matrices_device.downloaded(), matrices);
}

TEST_F(DeviceArrayTest, MayBeEmpty)
{
    DeviceArray<double> numbers(space(), "test/empty");
    numbers.fill_zero();
    numbers.upload(View<const double>());
    EXPECT_TRUE(numbers.downloaded().empty());
    EXPECT_TRUE(numbers.view().empty());
    EXPECT_EQ(space().memory().allocations, 0);
}

TEST_F(DeviceArrayTest, KeepsItsContentWhenItGrows)
{
    DeviceArray<int> numbers(space(), "test/growing");
    std::vector<int> expected = counting(1000);
    numbers.upload(expected);
    for (const int size : {1001, 5000, 100000}) {
        numbers.resize_keeping(size);
        EXPECT_EQ(numbers.size(), size);
        const std::vector<int> now = numbers.downloaded();
        EXPECT_TRUE(std::equal(expected.begin(), expected.end(), now.begin())) << size;
    }
    numbers.resize_keeping(10);
    expected.resize(10);
    EXPECT_EQ(numbers.downloaded(), expected);
}

TEST_F(DeviceArrayTest, AllocatesOnlyAboveItsLargestSize)
{
    DeviceArray<int> numbers(space(), "test/warm");
    EXPECT_EQ(allocations_of([&] { numbers.resize(1000); }), 1);
    EXPECT_EQ(space().memory().device_bytes, 4000U);
    EXPECT_EQ(allocations_of([&] {
                  numbers.resize(10);
                  numbers.resize_keeping(900);
                  numbers.upload(counting(1000));
                  numbers.fill_zero();
                  numbers.resize(0);
                  numbers.resize(1000);
              }),
              0);
    EXPECT_EQ(allocations_of([&] { numbers.resize_keeping(1001); }), 1);
    EXPECT_EQ(allocations_of([&] { numbers.resize_keeping(1500); }), 0); // it grew by half
}

TEST_F(DeviceArrayTest, ReleasesItsMemory)
{
    {
        DeviceArray<int> a(space(), "test/a", 1000);
        DeviceArray<int> b(std::move(a));
        DeviceArray<int> c(space(), "test/c", 500);
        c = std::move(b);
        const PinnedArray<int> d(space(), "test/d", 100);
        EXPECT_EQ(c.size(), 1000);
        EXPECT_EQ(space().memory().device_bytes, 4000U);
        EXPECT_EQ(space().memory().pinned_bytes, 400U);
    }
    EXPECT_EQ(space().memory().device_bytes, 0U);
    EXPECT_EQ(space().memory().pinned_bytes, 0U);
    EXPECT_EQ(space().memory().allocations, 3);
}

TEST_F(DeviceArrayTest, IsZeroedByteByByte)
{
    DeviceArray<double> numbers(space(), "test/zeros");
    numbers.upload(std::vector<double>(777, 3.0));
    numbers.fill_zero();
    EXPECT_EQ(numbers.downloaded(), std::vector<double>(777, 0.0));
}

/// Element of one mebibyte: 2^30 of them are a pebibyte.
struct Mebibyte {
    char bytes[1 << 20];
};

TEST_F(DeviceArrayTest, NamesPurposeAndSizeWhenMemoryRunsOut)
{
    DeviceArray<int> before(space(), "test/before");
    before.upload(counting(1000));
    DeviceArray<Mebibyte> too_large(space(), "test/pebibyte", 1);
    for (const bool keeping : {true, false}) {
        const std::string message = message_of<DeviceError>(
            [&] { keeping ? too_large.resize_keeping(1 << 30) : too_large.resize(1 << 30); });
        std::cout << message << "\n";
        EXPECT_TRUE(contains_in_order(message, "CUDA device 0 (", ") is out of memory: ",
                                      "'test/pebibyte' asked for 1073741824 MiB, ", " of ", " MiB are free"))
            << message;
        EXPECT_EQ(too_large.size(), keeping ? 1 : 0);
    }

    // The device remains usable after the refusal.
    launch(space(), CountVisits{before.view()});
    std::vector<int> expected = counting(1000);
    for (int& number : expected)
        ++number;
    EXPECT_EQ(before.downloaded(), expected);
}

TEST_F(PinnedArrayTest, RoundTripsThroughTheDevice)
{
    PinnedArray<double> pinned(space(), "test/there", 10000), back(space(), "test/back", 10000);
    for (int i = 0; i < pinned.size(); ++i)
        pinned[i] = 0.1 * i;
    DeviceArray<double> numbers(space(), "test/numbers");
    numbers.upload(pinned.view());
    numbers.download(back.view());
    space().synchronise();
    for (int i = 0; i < pinned.size(); ++i)
        ASSERT_EQ(back[i], 0.1 * i) << i;
}

TEST_F(PinnedArrayTest, IsCountedAsMemory)
{
    PinnedArray<double> numbers(space(), "test/pinned", 100);
    EXPECT_EQ(space().memory().allocations, 1);
    EXPECT_EQ(allocations_of([&] { numbers.resize(50); }), 0);
    EXPECT_EQ(allocations_of([&] { numbers.resize(101); }), 1);
}

} // namespace
} // namespace toile::test
