#include <cstdlib>
#include <iostream>

#include "core/backend/error.h"
#include "tests/core/cuda/kernels.h"
#include "tests/core/cuda/on_device.h"

namespace toile::test {
namespace {

/// A kernel that writes wild takes the device away from its process, so each of these runs in one of its own.
class CudaKernelFailureDeathTest : public OnDevice {
protected:
    void SetUp() override
    {
        GTEST_FLAG_SET(death_test_style,
                       "threadsafe"); // starts the program anew: CUDA does not survive a fork
        OnDevice::SetUp();
    }
};

/// Prints what is thrown after a good and a wild kernel and ends the process.
[[noreturn]] void fail_and_exit(CudaSpace::Checks checks)
{
    std::string message;
    {
        const CudaSpace space(0, checks);
        DeviceArray<int> visits(space, "test/visits", 1000);
        visits.fill_zero();
        message = message_of<DeviceError>([&] {
            launch(space, CountVisits{visits.view()});
            launch(space, WriteWild{View<int>(nullptr, 300)});
            space.synchronise();
        });
        // Arrays and space go on a device that no longer answers.
    }
    std::cerr << message << std::endl;
    std::_Exit(0);
}

TEST_F(CudaKernelFailureDeathTest, NamesTheKernelThatFailed)
{
    EXPECT_EXIT(fail_and_exit(CudaSpace::Checks::EveryLaunch), testing::ExitedWithCode(0),
                "kernel 'test/wild' \\(.*kernels\\.cu:[0-9]+\\) failed on CUDA device 0 \\(.*\\): an illegal "
                "memory access was encountered; noticed at .*kernels\\.cu:[0-9]+");
}

TEST_F(CudaKernelFailureDeathTest, NamesThoseItMayHaveBeenWhenNoticedLate)
{
    EXPECT_EXIT(fail_and_exit(CudaSpace::Checks::WhenSynchronised), testing::ExitedWithCode(0),
                "one of 2 kernels, the last of them 'test/visit' \\(.*kernels\\.cu:[0-9]+\\), 'test/wild' "
                "\\(.*kernels\\.cu:[0-9]+\\), failed on CUDA device 0 \\(.*\\): an illegal memory access was "
                "encountered; noticed at .*kernel_failure_test\\.cpp:[0-9]+");
}

} // namespace
} // namespace toile::test
