#include "core/compute/cuda/runtime/event.h"

#include "core/base/assert.h"
#include "core/base/error.h"

namespace toile {

StreamEvent::StreamEvent(const CudaSpace& space) : space_(&space)
{
    space.require(cuda::make_event(space.device().index, cuda::EventUse::Waiting, event_), "making an event");
}

StreamEvent::~StreamEvent() { static_cast<void>(cuda::destroy(event_)); }

void StreamEvent::record()
{
    space_->require(cuda::record(space_->device().index, event_, space_->stream()), "recording an event");
}

void StreamEvent::wait() const
{
    const cuda::Status status = cuda::wait_for(space_->device().index, event_);
    if (status != cuda::Status::Good)
        throw DeviceError("waiting for what " + space_->described() + " sends: " + cuda::reason_of(status));
}

void StreamEvent::delay(const CudaSpace& other) const
{
    TOILE_ASSERT(other.device().index == space_->device().index);
    other.require(cuda::delay(other.device().index, other.stream(), event_), "waiting for an event");
}

} // namespace toile
