#pragma once

#include "core/compute/cuda/runtime/device.h"

namespace toile {

/// Time between two points of a stream as the device sees it, kernels included: for benchmarks.
class DeviceTimer {
public:
    explicit DeviceTimer(const CudaSpace& space);
    ~DeviceTimer();
    DeviceTimer(const DeviceTimer&) = delete;
    DeviceTimer& operator=(const DeviceTimer&) = delete;

    /// Marks a point of the stream, reached once all work before it is done. Not while a graph is recorded.
    void start();
    void stop();

    /// Time from start() to stop() [ms], resolved to about 0.5 us. Waits for stop().
    double elapsed_ms() const;

private:
    const CudaSpace* space_;
    CUevent_st* start_ = nullptr;
    CUevent_st* stop_ = nullptr;
};

} // namespace toile
