#pragma once

#include "core/backend/cuda/device.h"

namespace toile {

/// A point of a stream, which any thread and other streams may wait for.
class StreamMark {
public:
    explicit StreamMark(const CudaSpace& space);
    ~StreamMark();
    StreamMark(const StreamMark&) = delete;
    StreamMark& operator=(const StreamMark&) = delete;

    /// Moves it behind all that the stream has been given.
    void set();

    /// Until the stream has come there.
    /// @throws DeviceError where the device no longer answers
    void await() const;

    /// The same for all that another stream of the device is given from now on; the host goes on.
    void hold_back(const CudaSpace& other) const;

private:
    const CudaSpace* space_;
    CUevent_st* event_ = nullptr;
};

} // namespace toile
