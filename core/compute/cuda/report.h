#pragma once

#include <string>

#include "core/compute/cuda/array.h"

namespace toile {

/// Record in the host's memory. Its number is written last: a reader that finds the number finds the record
/// too.
template <typename T>
struct Reported {
    T record;
    unsigned number;
};

/// Sends a report from one thread of a kernel.
template <typename T>
struct SendReport {
    View<Reported<T>> slot; ///< [1]
    unsigned number;

    TOILE_HD void operator()(const T& record) const
    {
        slot[0].record = record;
#ifdef __CUDA_ARCH__
        __threadfence_system();
#endif
        *const_cast<volatile unsigned*>(&slot[0].number) = number;
    }
};

/// Record that a kernel writes straight into the host's memory, where the host awaits it. That takes no copy,
/// and does not wait for later work of the stream.
template <typename T>
class DeviceReport {
public:
    /// @param space  borrowed
    DeviceReport(const CudaSpace& space, const std::string& name) : space_(&space), slot_(space, name, 1)
    {
        slot_[0] = {};
    }

    /// Sender for the kernel that is launched next. Not for graphs, in which every launch would send the same
    /// number.
    SendReport<T> next()
    {
        TOILE_ASSERT(!space_->is_recording());
        return {slot_.view(), ++number_};
    }

    /// Record of the last next(). All work that the stream was given before its kernel is complete as well. A
    /// call of stage "cuda/wait" if the record has not arrived yet.
    /// @throws DeviceError as CudaSpace::synchronise(), or if no kernel sends the record
    T await(CallSite where = CallSite::here()) const
    {
        space_->await(slot_[0].number, number_, where);
        return slot_[0].record;
    }

private:
    const CudaSpace* space_;
    mutable PinnedArray<Reported<T>> slot_;
    unsigned number_ = 0;
};

} // namespace toile
