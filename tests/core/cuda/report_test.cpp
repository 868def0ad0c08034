#include "core/backend/cuda/report.h"

#include "core/backend/error.h"
#include "core/backend/stages.h"
#include "tests/core/cuda/kernels.h"
#include "tests/core/cuda/on_device.h"

namespace toile::test {
namespace {

using CudaReport = OnDevice;

TEST_F(CudaReport, ComesWholeEveryTime)
{
    DeviceReport<Numbers> report(space(), "test/report");
    for (int k = 0; k < 2000; ++k) {
        launch(space(), SendNumbers{report.next(), double(k)});
        const Numbers numbers = report.await();
        for (int j = 0; j < Numbers::kCount; ++j)
            ASSERT_EQ(numbers.of[j], k + 0.25 * j) << k;
    }
}

TEST_F(CudaReport, IsTheLastOfSeveral)
{
    DeviceReport<Numbers> report(space(), "test/report");
    for (int k = 0; k < 10; ++k)
        launch(space(), SendNumbers{report.next(), double(k)});
    EXPECT_EQ(report.await().of[0], 9.0);
    EXPECT_EQ(report.await().of[0], 9.0) << "it stays";
}

/// A kernel behind the report waits for the host, and gives up some seconds later: it hears of the host only
/// where the host has not waited for it.
TEST_F(CudaReport, IsNotHeldUpByWhatComesBehind)
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

TEST_F(CudaReport, ThatNobodySendsIsAnError)
{
    DeviceReport<Numbers> report(space(), "test/report");
    static_cast<void>(report.next());
    EXPECT_NE(message_of<DeviceError>([&] { report.await(); }).find("sends the report"), std::string::npos);
}

TEST_F(CudaReport, IsWaitedForOnlyUntilItHasCome)
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
