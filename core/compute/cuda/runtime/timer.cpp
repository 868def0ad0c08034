#include "core/compute/cuda/runtime/timer.h"

namespace toile {

DeviceTimer::DeviceTimer(const CudaSpace& space) : space_(&space)
{
    space.require(cuda::make_event(space.device().index, cuda::EventUse::Timing, start_), "making a timer");
    const cuda::Status made = cuda::make_event(space.device().index, cuda::EventUse::Timing, stop_);
    if (made != cuda::Status::Good)
        static_cast<void>(cuda::destroy(start_));
    space.require(made, "making a timer");
}

DeviceTimer::~DeviceTimer()
{
    static_cast<void>(cuda::destroy(start_));
    static_cast<void>(cuda::destroy(stop_));
}

void DeviceTimer::start()
{
    space_->require(cuda::record(space_->device().index, start_, space_->stream()), "starting a timer");
}

void DeviceTimer::stop()
{
    space_->require(cuda::record(space_->device().index, stop_, space_->stream()), "stopping a timer");
}

double DeviceTimer::elapsed_ms() const
{
    space_->require(cuda::wait_for(space_->device().index, stop_), "waiting for a timer");
    float ms = 0.0F;
    space_->require(cuda::elapsed_ms(start_, stop_, ms), "reading a timer");
    return double(ms);
}

} // namespace toile
