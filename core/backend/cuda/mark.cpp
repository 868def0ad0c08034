#include "core/backend/cuda/mark.h"

#include "core/backend/error.h"

namespace toile {

StreamMark::StreamMark(const CudaSpace& space) : space_(&space)
{
    space.require(cuda::make_event(space.device().index, event_), "making a mark");
}

StreamMark::~StreamMark() { static_cast<void>(cuda::destroy(event_)); }

void StreamMark::set()
{
    space_->require(cuda::record(space_->device().index, event_, space_->stream()), "marking the stream");
}

void StreamMark::await() const
{
    const cuda::Status status = cuda::wait_for(space_->device().index, event_);
    if (status != cuda::Status::Good)
        throw DeviceError("waiting for what " + space_->described() + " sends: " + cuda::reason_of(status));
}

void StreamMark::hold_back(const CudaSpace& other) const
{
    other.require(cuda::hold_back(other.device().index, other.stream(), event_), "waiting for a mark");
}

} // namespace toile
