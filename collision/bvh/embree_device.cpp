#include "collision/bvh/embree_device.h"

#include <string>

#include <embree3/rtcore.h>

#include "core/base/error.h"

namespace toile::collision {

namespace {

/// Embree device that lives until the program ends.
class Device {
public:
    Device() : device_(rtcNewDevice(nullptr))
    {
        if (device_ == nullptr)
            throw DeviceError("Embree does not start (error " + std::to_string(rtcGetDeviceError(nullptr)) +
                              "); it needs a processor with SSE2");
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

} // namespace toile::collision
