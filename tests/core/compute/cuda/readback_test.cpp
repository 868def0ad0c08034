#include "core/compute/cuda/readback.h"

#include <future>
#include <numeric>

#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

using CudaReadback = OnDevice;

std::vector<int> counted(int count, int first)
{
    std::vector<int> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

TEST_F(CudaReadback, HoldsTheArrayAtTheTimeOfTheRequest)
{
    DeviceArray<int> on_gpu(space(), "test/values");
    Readback<int> readback(space(), "test/readback");
    for (const int count : {1000, 1, 300000}) {
        const std::vector<int> values = counted(count, count);
        on_gpu.upload(values);
        readback.begin(on_gpu);
        on_gpu.fill_zero();
        const View<const int> here = readback.await();
        EXPECT_EQ(std::vector<int>(here.begin(), here.end()), values);
    }
}

/// The kernel occupies the stream until the host continues; the test would fail if begin() blocked the host.
TEST_F(CudaReadback, IsAwaitedByOtherThreadsWithoutBlockingTheHost)
{
    const CudaSpace space(0, CudaSpace::Checks::WhenSynchronised);
    const std::vector<int> values = counted(5000, 7);
    DeviceArray<int> on_gpu(space, "test/values"), heard(space, "test/heard", 1);
    on_gpu.upload(values);
    PinnedArray<int> word(space, "test/word", 1);
    word[0] = 0;
    Readback<int> readback(space, "test/readback");
    readback.begin(on_gpu); // allocates its memory
    readback.await();

    launch(space, HearFromHost{word.view(), heard.view()});
    readback.begin(on_gpu);
    const auto read = [&] {
        const View<const int> here = readback.await();
        return std::vector<int>(here.begin(), here.end());
    };
    std::future<std::vector<int>> one = std::async(std::launch::async, read),
                                  other = std::async(std::launch::async, read);
    *const_cast<volatile int*>(&word[0]) = 1;
    EXPECT_EQ(one.get(), values);
    EXPECT_EQ(other.get(), values);
    EXPECT_EQ(heard.downloaded()[0], 1);
}

TEST_F(CudaReadback, IsReusedOnceReleased)
{
    DeviceArray<int> on_gpu(space(), "test/values");
    on_gpu.upload(counted(100, 0));
    ReadbackPool<int> pool(space(), "test/readback");
    const auto held = pool.take();
    held->begin(on_gpu);
    const View<const int> here = held->await();
    const long allocations = space().memory().allocations;
    for (int k = 1; k < 20; ++k) {
        on_gpu.upload(counted(100, 1000 * k));
        const auto next = pool.take();
        next->begin(on_gpu);
        EXPECT_EQ(next->await()[0], 1000 * k);
        EXPECT_EQ(here[99], 99) << "still held";
    }
    EXPECT_EQ(space().memory().allocations, allocations + 1);
}

} // namespace
} // namespace toile::test
