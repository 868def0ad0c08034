#include <algorithm>
#include <climits>
#include <iostream>

#include "core/base/error.h"
#include "core/base/stages.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

using CudaParallelFor = OnDevice;

TEST_F(CudaParallelFor, VisitsEveryItemOnce)
{
    for (const int block : {32, 256, 1024})
        for (const int count : {0, 1, 31, 255, 256, 257, 1023, 1024, 1025, 1000000}) {
            DeviceArray<int> visits(space(), "test/visits", count);
            visits.fill_zero();
            launch(space(), CountVisits{visits.view()}, block);
            ASSERT_EQ(visits.downloaded(), std::vector<int>(count, 1)) << count << " in blocks of " << block;
        }
}

/// The index of the last item plus a block is beyond int.
TEST_F(CudaParallelFor, ReachesTheLargestCount)
{
    DeviceArray<int> visits(space(), "test/ends", 2);
    visits.fill_zero();
    launch(space(), CountEndVisits{INT_MAX, visits.view()});
    EXPECT_EQ(visits.downloaded(), std::vector<int>(2, 1));
}

TEST_F(CudaParallelFor, RunsInTheOrderOfItsLaunches)
{
    DeviceArray<double> sum(space(), "test/sum"), factor(space(), "test/factor");
    sum.upload(std::vector<double>(1000, 1.0));
    factor.upload(std::vector<double>(1, 3.0));
    for (int i = 0; i < 10; ++i) {
        launch(space(), ScaleBySlot{factor.view(), sum.view()}); // 3 x
        launch(space(), AddScaled{sum.view(), 1.0, sum.view()}); // 6 x
    }
    EXPECT_EQ(sum.downloaded(), std::vector<double>(1000, 60466176.0)); // 6^10
}

/// Fibonacci numbers: values loaded in the prologue are of the launch before the last, and complete.
TEST_F(CudaParallelFor, LoadsOnlyFinishedResultsInThePrologue)
{
    for (const int count : {1, 1000, 1000000}) {
        DeviceArray<unsigned> fields[3]{{space(), "test/fields", count},
                                        {space(), "test/fields", count},
                                        {space(), "test/fields", count}};
        fields[0].upload(std::vector<unsigned>(count, 0));
        fields[1].upload(std::vector<unsigned>(count, 1));
        for (int k = 2; k <= 46; ++k)
            launch(space(),
                   AddLastTwo{fields[(k - 2) % 3].view(), fields[(k - 1) % 3].view(), fields[k % 3].view()});
        ASSERT_EQ(fields[46 % 3].downloaded(), std::vector<unsigned>(count, 1836311903U)) << count;
    }
}

TEST_F(CudaParallelFor, IsOneCallOfItsStage)
{
    Stages stages;
    const Stages::Activate activate(stages);
    DeviceArray<int> visits(space(), "test/visits", 10);
    launch(space(), CountVisits{visits.view()});
    launch(space(), CountVisits{View<int>()}); // empty: counted, not launched
    EXPECT_EQ(stages.calls("test/visit"), 2);
    space().synchronise();
}

TEST_F(CudaParallelFor, NamesKernelAndCallSiteWhenALaunchIsRefused)
{
    DeviceArray<int> visits(space(), "test/visits", 10);
    visits.fill_zero();
    const std::string message =
        message_of<DeviceError>([&] { launch(space(), CountVisits{visits.view()}, 2000); });
    std::cout << message << "\n";
    EXPECT_TRUE(contains_in_order(message, "kernel 'test/visit' (",
                                  "kernels.cu:", ") could not be launched on CUDA device 0 (", "): invalid"))
        << message;

    launch(space(), CountVisits{visits.view()});
    EXPECT_EQ(visits.downloaded(), std::vector<int>(10, 1));
}

TEST_F(CudaParallelFor, AllocatesNothing)
{
    DeviceArray<int> visits(space(), "test/visits", 10);
    EXPECT_EQ(allocations_of([&] { launch(space(), CountVisits{visits.view()}); }), 0);
    space().synchronise();
}

} // namespace
} // namespace toile::test
