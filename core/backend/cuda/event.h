#pragma once

#include "core/backend/cuda/device.h"

namespace toile {

/// A point of a stream, which any thread and other streams may wait for.
class StreamEvent {
public:
    /// @param space  borrowed
    /// @throws DeviceError where the device refuses, as do all calls
    explicit StreamEvent(const CudaSpace& space);
    ~StreamEvent();
    StreamEvent(const StreamEvent&) = delete;
    StreamEvent& operator=(const StreamEvent&) = delete;

    /// Moves it behind all that the stream has been given.
    void record();

    /// Until the stream has come there, without taking a core; at once where nothing was recorded yet.
    void wait() const;

    /// The same for all that `other`, a space of the same device, is given from now on; the host goes on.
    void delay(const CudaSpace& other) const;

private:
    const CudaSpace* space_;
    CUevent_st* event_ = nullptr;
};

} // namespace toile
