#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/event.h"

namespace toile {

/// A copy of an array of a device on its way to the host (asynchronous readback): device and host go on
/// meanwhile, and who needs it waits for it, on whatever thread. Like arrays it must not outlive its space.
template <typename T>
class Readback {
public:
    /// @param space  borrowed
    Readback(const CudaSpace& space, const std::string& name) : here_(space, name), arrived_(space) {}

    /// Begins a copy, in the stream's turn, and returns. Nobody may be reading the one before.
    void begin(const DeviceArray<T>& there)
    {
        here_.resize(there.size());
        there.download(here_.view());
        arrived_.record();
    }

    /// The array as it was. Waits; from any thread, and from several at once.
    /// @throws DeviceError where the device no longer answers
    View<const T> await() const
    {
        arrived_.wait();
        return here_.view();
    }

private:
    PinnedArray<T> here_;
    StreamEvent arrived_;
};

/// Readbacks, each of which is used again once nobody holds it any more.
template <typename T>
class ReadbackPool {
public:
    /// @param space  borrowed
    ReadbackPool(const CudaSpace& space, std::string name) : space_(&space), name_(std::move(name)) {}

    /// One that nobody else has.
    std::shared_ptr<Readback<T>> take()
    {
        for (const std::shared_ptr<Readback<T>>& readback : all_)
            if (readback.use_count() == 1) {
                std::atomic_thread_fence(std::memory_order_acquire); // what its last reader read is read
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
