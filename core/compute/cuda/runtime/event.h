#pragma once

#include "core/compute/cuda/runtime/device.h"

namespace toile {

/// Point of a stream, which any thread and other streams may wait for.
class StreamEvent {
public:
    /// @param space  borrowed
    /// @throws DeviceError if the device refuses, as do all calls
    explicit StreamEvent(const CudaSpace& space);
    ~StreamEvent();
    StreamEvent(const StreamEvent&) = delete;
    StreamEvent& operator=(const StreamEvent&) = delete;

    /// Moves the point behind all work that the stream has been given.
    void record();

    /// Waits until the stream reaches the point, without occupying a core; returns at once if nothing was
    /// recorded.
    void wait() const;

    /// Delays all later work of `other`, a space of the same device, until the stream reaches the point. The
    /// host goes on.
    void delay(const CudaSpace& other) const;

private:
    const CudaSpace* space_;
    CUevent_st* event_ = nullptr;
};

} // namespace toile
