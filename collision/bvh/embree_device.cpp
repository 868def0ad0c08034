#include "collision/bvh/embree_device.h"

#include <new>
#include <string>

#include <embree3/rtcore.h>

#include "core/base/error.h"

namespace toile::collision {

namespace {

[[noreturn]] void fail(const char* what, RTCError error)
{
    if (error == RTC_ERROR_OUT_OF_MEMORY)
        throw std::bad_alloc();
    throw DeviceError(std::string("Embree ") + what + " (error " + std::to_string(error) + ")");
}

/// Embree device that lives until the program ends.
class Device {
public:
    Device() : device_(rtcNewDevice(nullptr))
    {
        if (device_ == nullptr)
            fail("does not start; it needs a processor with SSE2", rtcGetDeviceError(nullptr));
    }
    ~Device() { rtcReleaseDevice(device_); }
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    RTCDevice get() const { return device_; }

private:
    RTCDevice device_;
};

} // namespace

RTCDeviceTy* embree_device()
{
    static const Device device;
    return device.get();
}

void require_embree_success()
{
    if (const RTCError error = rtcGetDeviceError(embree_device()); error != RTC_ERROR_NONE)
        fail("failed", error);
}

} // namespace toile::collision
