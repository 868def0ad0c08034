#include <cstdlib>
#include <iostream>

#include "core/backend/cuda/answers.h"
#include "core/backend/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/world.h"
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

/// Asks devices whether they answer, before and after a wild kernel on device 0, and ends the process.
[[noreturn]] void ask_and_exit()
{
    const auto ask = [] {
        std::string all;
        for (const CudaDevice& device : cuda_devices())
            all += answers(device.index) ? "yes " : "no ";
        return all;
    };
    std::cerr << "before: " << ask();
    const CudaSpace space(0, CudaSpace::Checks::EveryLaunch);
    message_of<DeviceError>([&] { launch(space, WriteWild{View<int>(nullptr, 300)}); });
    std::cerr << "after: " << ask() << std::endl;
    std::_Exit(0);
}

/// The others go on.
TEST_F(CudaKernelFailureDeathTest, LeavesADeviceThatNoLongerAnswers)
{
    EXPECT_EXIT(ask_and_exit(), testing::ExitedWithCode(0), "before: (yes )+after: no (yes )*");
}

/// Steps a world before and after a wild kernel on its device, and ends the process.
[[noreturn]] void step_and_exit()
{
    const Scene scene = parse_scene(R"({"toile": 1, "frames": 3, "cloths": [
        {"name": "sheet", "rectangle": {"size": [0.3, 0.3], "resolution": 0.02}}]})",
                                    "test.json");
    std::string before, after;
    {
        WorldOptions options;
        options.backend = Backend::Cuda;
        World world(scene, options);
        before = message_of<DeviceError>([&] { world.advance_frame(); });
        const CudaSpace space(0, CudaSpace::Checks::EveryLaunch);
        message_of<DeviceError>([&] { launch(space, WriteWild{View<int>(nullptr, 300)}); });
        after = message_of<DeviceError>([&] { world.advance_frame(); });
        // The world goes on a device that no longer answers.
    }
    std::cerr << "before: " << before << ", after: " << after << std::endl;
    std::_Exit(0);
}

/// As `toile simulate` needs it: one error, and the world can be taken away.
TEST_F(CudaKernelFailureDeathTest, EndsAWorldWithAnError)
{
    EXPECT_EXIT(step_and_exit(), testing::ExitedWithCode(0), "before: , after: .*CUDA device 0 \\(.*\\)");
}

} // namespace
} // namespace toile::test
