#include <cstdlib>
#include <iostream>

#include "core/base/error.h"
#include "core/compute/cuda/runtime/answers.h"
#include "scenes/format/read_scene.h"
#include "scenes/world/world.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

using namespace scenes;

namespace {

/// Tests in separate processes: a kernel that writes out of bounds makes the device unusable for its process.
class CudaKernelFailureDeathTest : public OnDevice {
protected:
    void SetUp() override
    {
        GTEST_FLAG_SET(death_test_style,
                       "threadsafe"); // restarts the program: CUDA does not survive a fork
        OnDevice::SetUp();
    }
};

/// Prints the errors after a valid and an invalid kernel and ends the process.
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
        // Arrays and space are destroyed on a device that no longer responds.
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

TEST_F(CudaKernelFailureDeathTest, NamesTheCandidateKernelsWhenDetectedLate)
{
    EXPECT_EXIT(fail_and_exit(CudaSpace::Checks::WhenSynchronised), testing::ExitedWithCode(0),
                "one of 2 kernels, the last of them 'test/visit' \\(.*kernels\\.cu:[0-9]+\\), 'test/wild' "
                "\\(.*kernels\\.cu:[0-9]+\\), failed on CUDA device 0 \\(.*\\): an illegal memory access was "
                "encountered; noticed at .*kernel_failure_test\\.cpp:[0-9]+");
}

/// Queries whether devices respond, before and after an invalid kernel on device 0, and ends the process.
[[noreturn]] void ask_and_exit()
{
    const auto ask = [] {
        std::string all;
        for (const CudaDevice& device : cuda_devices())
            all += is_responding(device.index) ? "yes " : "no ";
        return all;
    };
    std::cerr << "before: " << ask();
    const CudaSpace space(0, CudaSpace::Checks::EveryLaunch);
    message_of<DeviceError>([&] { launch(space, WriteWild{View<int>(nullptr, 300)}); });
    std::cerr << "after: " << ask() << std::endl;
    std::_Exit(0);
}

/// The other devices continue.
TEST_F(CudaKernelFailureDeathTest, DetectsADeviceThatNoLongerResponds)
{
    EXPECT_EXIT(ask_and_exit(), testing::ExitedWithCode(0), "before: (yes )+after: no (yes )*");
}

/// Steps a world before and after an invalid kernel on its device, and ends the process.
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
        // The world is destroyed on a device that no longer responds.
    }
    std::cerr << "before: " << before << ", after: " << after << std::endl;
    std::_Exit(0);
}

/// Requirement of `toile simulate`: one error, and the world can be destroyed.
TEST_F(CudaKernelFailureDeathTest, EndsAWorldWithAnError)
{
    EXPECT_EXIT(step_and_exit(), testing::ExitedWithCode(0), "before: , after: .*CUDA device 0 \\(.*\\)");
}

} // namespace
} // namespace toile::test
