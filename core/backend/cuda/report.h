#pragma once

#include <string>

#include "core/backend/cuda/array.h"

namespace toile {

/// A record in the host's memory. Its number is written last: who finds that finds the record too.
template <typename T>
struct Reported {
    T record;
    unsigned number;
};

/// What a kernel has to send a report by, from one thread.
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

/// A record that a kernel writes straight into the host's memory, where the host awaits it: neither a copy
/// nor the end of what the stream has been given after it.
template <typename T>
class DeviceReport {
public:
    /// @param space  borrowed
    DeviceReport(const CudaSpace& space, const std::string& name) : space_(&space), slot_(space, name, 1)
    {
        slot_[0] = {};
    }

    /// For the kernel that is launched next; not for graphs, in which every launch would send the same
    /// number.
    SendReport<T> next()
    {
        TOILE_ASSERT(!space_->is_recording());
        return {slot_.view(), ++number_};
    }

    /// The report of the last next(). All that the stream was given before its kernel is done as well. A call
    /// of stage "cuda/wait" where it has not come yet.
    /// @throws DeviceError as CudaSpace::synchronise(); or where no kernel sends it
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
