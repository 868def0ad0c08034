#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/compute/cuda/array.h"
#include "core/compute/cuda/runtime/event.h"

namespace toile {

/// Asynchronous copy of a device's array to the host. Device and host go on meanwhile, and any thread that
/// needs the copy waits for it. Like arrays it must not outlive its space.
template <typename T>
class Readback {
public:
    /// @param space  borrowed
    Readback(const CudaSpace& space, const std::string& name) : on_host_(space, name), arrived_(space) {}

    /// Begins a copy in stream order and returns. No thread may be reading the previous copy.
    void begin(const DeviceArray<T>& array)
    {
        on_host_.resize(array.size());
        array.download(on_host_.view());
        arrived_.record();
    }

    /// Array as it was at begin(). Waits for it; any number of threads may call this at once.
    /// @throws DeviceError if the device no longer responds
    View<const T> await() const
    {
        arrived_.wait();
        return on_host_.view();
    }

private:
    PinnedArray<T> on_host_;
    StreamEvent arrived_;
};

/// Pool of readbacks; each is reused once it has no other owner.
template <typename T>
class ReadbackPool {
public:
    /// @param space  borrowed
    ReadbackPool(const CudaSpace& space, std::string name) : space_(&space), name_(std::move(name)) {}

    /// Readback without another owner.
    std::shared_ptr<Readback<T>> take()
    {
        for (const std::shared_ptr<Readback<T>>& readback : all_)
            if (readback.use_count() == 1) {
                std::atomic_thread_fence(std::memory_order_acquire); // orders the last reads before reuse
                return readback;
            }
        return all_.emplace_back(std::make_shared<Readback<T>>(*space_, name_));
    }

private:
    const CudaSpace* space_;
    std::string name_;
    std::vector<std::shared_ptr<Readback<T>>> all_;
};

} // namespace toile
