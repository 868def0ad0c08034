#include <iostream>

#include "core/base/error.h"
#include "core/compute/cuda/runtime/timer.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

TEST(CudaDevices, AreListedOrTheReasonIsGiven)
{
    const std::vector<CudaDevice> devices = cuda_devices();
    const std::string reason = why_no_cuda_device();
    EXPECT_EQ(devices.empty(), !reason.empty());
    if (devices.empty())
        std::cout << "no CUDA device: " << reason << "\n";
    for (const CudaDevice& device : devices) {
        std::cout << "CUDA device " << device.index << ": " << device.name << ", " << (device.memory >> 20)
                  << " MiB, " << device.multiprocessors << " multiprocessors, compute capability "
                  << device.capability_major << "." << device.capability_minor << "\n";
        EXPECT_FALSE(device.name.empty());
        EXPECT_GT(device.memory, size_t(1) << 28);
        EXPECT_GT(device.multiprocessors, 0);
        EXPECT_GE(device.capability_major, 7);
        EXPECT_EQ(device.index, &device - devices.data());
    }
}

/// Each possible reason comes with a remedy.
TEST(CudaDevices, AreMissingForAKnownReason)
{
    const std::string reason = why_no_cuda_device();
    if (reason.empty())
        GTEST_SKIP() << "this machine has a CUDA device";
    EXPECT_TRUE(reason == "this build is without CUDA" || reason == "no driver is installed" ||
                reason == "the driver finds no device" || reason.starts_with("the driver knows CUDA "))
        << reason;
}

TEST(CudaSpaceErrors, NameTheMissingDevice)
{
    for (const int index : {99, -1}) {
        const std::string message = message_of<DeviceError>([&] { const CudaSpace space(index); });
        std::string start = "CUDA device " + std::to_string(index) + ": ";
        const std::string reason = why_no_cuda_device();
        if (reason.empty())
            EXPECT_TRUE(message.starts_with(start + "there is no such device; choose one of 0 (")) << message;
        else
            EXPECT_EQ(message, start.append("there is none, because ").append(reason));
    }
}

using CudaSpaceTest = OnDevice;

TEST_F(CudaSpaceTest, SynchronisesWhenIdle)
{
    space().synchronise();
    EXPECT_FALSE(space().is_recording());
    EXPECT_EQ(space().memory().allocations, 0);
}

/// Host and device agree on the memory layout of exchanged types.
TEST_F(CudaSpaceTest, AgreesWithTheHostOnLayouts)
{
    DeviceArray<int> device(space(), "test/layout", WriteLayout::kNumbers);
    std::vector<int> host(WriteLayout::kNumbers);
    launch(space(), WriteLayout{device.view()});
    WriteLayout{host}(0);
    EXPECT_EQ(device.downloaded(), host);
}

TEST_F(CudaSpaceTest, CoexistsWithOthers)
{
    const CudaSpace other(0);
    DeviceArray<int> first(space(), "test/here", 1000), second(other, "test/there", 1000);
    first.fill_zero();
    second.fill_zero();
    for (int i = 0; i < 10; ++i) {
        launch(space(), CountVisits{first.view()});
        launch(other, CountVisits{second.view()});
    }
    EXPECT_EQ(first.downloaded(), std::vector<int>(1000, 10));
    EXPECT_EQ(second.downloaded(), std::vector<int>(1000, 10));
}

using DeviceTimerTest = OnDevice;

TEST_F(DeviceTimerTest, MeasuresTheKernelsInBetween)
{
    DeviceArray<int> visits(space(), "test/visits", 1 << 22);
    visits.fill_zero();
    DeviceTimer timer(space());
    timer.start();
    for (int i = 0; i < 20; ++i)
        launch(space(), CountVisits{visits.view()});
    timer.stop();
    const double ms = timer.elapsed_ms();
    EXPECT_GT(ms, 0.0);
    std::cout << "20 kernels over 4 Mi items: " << ms << " ms\n";
    EXPECT_EQ(visits.downloaded(), std::vector<int>(1 << 22, 20));
}

TEST_F(DeviceTimerTest, RefusesToBeReadBeforeItRan)
{
    const DeviceTimer timer(space());
    EXPECT_TRUE(message_of<DeviceError>([&] { static_cast<void>(timer.elapsed_ms()); }) != "");
    space().synchronise();
}

} // namespace
} // namespace toile::test
