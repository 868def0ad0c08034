#include "core/compute/cuda/report.h"

#include "core/base/error.h"
#include "core/base/stages.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

using CudaReport = OnDevice;

TEST_F(CudaReport, ArrivesComplete)
{
    DeviceReport<Numbers> report(space(), "test/report");
    for (int k = 0; k < 2000; ++k) {
        launch(space(), SendNumbers{report.next(), double(k)});
        const Numbers numbers = report.await();
        for (int j = 0; j < Numbers::kCount; ++j)
            ASSERT_EQ(numbers.of[j], k + 0.25 * j) << k;
    }
}

TEST_F(CudaReport, IsTheLastOfSeveralReports)
{
    DeviceReport<Numbers> report(space(), "test/report");
    for (int k = 0; k < 10; ++k)
        launch(space(), SendNumbers{report.next(), double(k)});
    EXPECT_EQ(report.await().of[0], 9.0);
    EXPECT_EQ(report.await().of[0], 9.0) << "it stays";
}

/// A kernel behind the report waits for the host and gives up after some seconds. It sees the host's word
/// only if the host did not wait for the kernel.
TEST_F(CudaReport, DoesNotWaitForLaterKernels)
{
    const CudaSpace space(0, CudaSpace::Checks::WhenSynchronised);
    DeviceReport<Numbers> report(space, "test/report");
    PinnedArray<int> word(space, "test/word", 1);
    DeviceArray<int> heard(space, "test/heard", 1);
    word[0] = 0;
    launch(space, SendNumbers{report.next(), 1.0});
    launch(space, HearFromHost{word.view(), heard.view()});
    EXPECT_EQ(report.await().of[0], 1.0);
    *const_cast<volatile int*>(&word[0]) = 1;
    EXPECT_EQ(heard.downloaded()[0], 1);
}

TEST_F(CudaReport, ThatIsNeverSentIsAnError)
{
    DeviceReport<Numbers> report(space(), "test/report");
    static_cast<void>(report.next());
    EXPECT_NE(message_of<DeviceError>([&] { report.await(); }).find("sends the report"), std::string::npos);
}

TEST_F(CudaReport, IsWaitedForOnlyUntilItArrives)
{
    DeviceReport<Numbers> report(space(), "test/report");
    launch(space(), SendNumbers{report.next(), 1.0});
    space().synchronise();
    Stages stages;
    const Stages::Activate activate(stages);
    report.await();
    EXPECT_EQ(stages.calls("cuda/wait"), 0);
}

} // namespace
} // namespace toile::test
