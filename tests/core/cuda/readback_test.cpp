#include "core/backend/cuda/readback.h"

#include <future>
#include <numeric>

#include "tests/core/cuda/kernels.h"
#include "tests/core/cuda/on_device.h"

namespace toile::test {
namespace {

using CudaReadback = OnDevice;

std::vector<int> counted(int count, int first)
{
    std::vector<int> values(count);
    std::iota(values.begin(), values.end(), first);
    return values;
}

TEST_F(CudaReadback, HasTheArrayAsItWas)
{
    DeviceArray<int> there(space(), "test/values");
    Readback<int> readback(space(), "test/readback");
    for (const int count : {1000, 1, 300000}) {
        const std::vector<int> values = counted(count, count);
        there.upload(values);
        readback.begin(there);
        there.fill_zero();
        const View<const int> here = readback.await();
        EXPECT_EQ(std::vector<int>(here.begin(), here.end()), values);
    }
}

/// The stream stands until the host goes on, which it would not do if it waited.
TEST_F(CudaReadback, IsWaitedForByOthersWhileTheHostGoesOn)
{
    const CudaSpace space(0, CudaSpace::Checks::WhenSynchronised);
    const std::vector<int> values = counted(5000, 7);
    DeviceArray<int> there(space, "test/values"), heard(space, "test/heard", 1);
    there.upload(values);
    PinnedArray<int> word(space, "test/word", 1);
    word[0] = 0;
    Readback<int> readback(space, "test/readback");
    readback.begin(there); // has its memory
    readback.await();

    launch(space, HearFromHost{word.view(), heard.view()});
    readback.begin(there);
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

TEST_F(CudaReadback, IsUsedAgainOnceNobodyHoldsIt)
{
    DeviceArray<int> there(space(), "test/values");
    there.upload(counted(100, 0));
    ReadbackPool<int> pool(space(), "test/readback");
    const auto held = pool.take();
    held->begin(there);
    const View<const int> here = held->await();
    const long allocations = space().memory().allocations;
    for (int k = 1; k < 20; ++k) {
        there.upload(counted(100, 1000 * k));
        const auto next = pool.take();
        next->begin(there);
        EXPECT_EQ(next->await()[0], 1000 * k);
        EXPECT_EQ(here[99], 99) << "still held";
    }
    EXPECT_EQ(space().memory().allocations, allocations + 1);
}

} // namespace
} // namespace toile::test
