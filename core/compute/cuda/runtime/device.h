#pragma once

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/call_site.h"
#include "core/compute/cuda/runtime/runtime.h"

namespace toile {

/// GPUs that this process can use; none in a build without CUDA or on a machine without a driver.
std::vector<CudaDevice> cuda_devices();

/// Reason why cuda_devices() lists none, e.g. "no driver is installed"; empty if it lists some.
std::string why_no_cuda_device();

/// One stream of one GPU: its work runs in the order given, beside the host. The counterpart of CpuSpace in
/// the kernels' launches (parallel.cuh).
///
/// Used by one thread at a time. It must outlive the arrays, graphs and timers made on it.
class CudaSpace {
public:
    /// Time at which an error inside a kernel is noticed. Waiting after every launch names the kernel
    /// exactly, but host and device no longer overlap.
    enum class Checks { WhenSynchronised, EveryLaunch };

    /// Checks every launch in Debug and RelWithDebInfo, as TOILE_ASSERT does.
    /// @throws DeviceError in one sentence: no such device, or why there is none.
    explicit CudaSpace(int device);
    CudaSpace(int device, Checks checks);

    /// Tag: another stream of the same device, with the same checks and one count of memory.
    struct Beside {};
    CudaSpace(const CudaSpace& other, Beside);
    ~CudaSpace();
    CudaSpace(const CudaSpace&) = delete;
    CudaSpace& operator=(const CudaSpace&) = delete;

    const CudaDevice& device() const { return device_; }
    std::string described() const; ///< "CUDA device 0 (NVIDIA H200)"
    CUstream_st* stream() const { return stream_; }

    /// Waits until all work that the stream was given is done. A call of stage "cuda/wait".
    /// @throws DeviceError if a kernel failed, of this or another space of the device: names the kernels
    ///         launched since the last wait with file and line, and CUDA's reason. This process can't use the
    ///         device any more.
    void synchronise(CallSite where = CallSite::here()) const;

    /// Waits until a kernel has written `value` into `word`, which lies in a PinnedArray (report.h). Later
    /// work of the stream may still run. A call of stage "cuda/wait" if the value is not there yet.
    /// @throws DeviceError as synchronise(); also if the stream is done and nothing was written.
    void await(unsigned& word, unsigned value, CallSite where = CallSite::here()) const;

    /// True while a CudaGraph records: work given to the stream is kept, not run.
    bool is_recording() const { return cuda::is_recording(stream_); }

    /// Memory that arrays of this space, and of those beside it, have allocated since it was made. Steps
    /// after the first should leave `allocations` as it is.
    struct Memory {
        long allocations = 0;         ///< calls of the device's allocator so far
        std::size_t device_bytes = 0; ///< held now on the device [bytes]
        std::size_t pinned_bytes = 0; ///< held now on the host, unswappable [bytes]
    };
    const Memory& memory() const { return *memory_; }

    /// Memory that the device has left [bytes].
    std::size_t free_memory() const;

    /// @throws DeviceError if the device has less than `bytes` left: "... is out of memory: WHAT N MiB, ..."
    void require_memory(std::size_t bytes, std::string_view what) const;

private:
    friend class CudaBuffer;
    friend class CudaGraph;
    friend class DeviceTimer;
    friend class StreamEvent;
    friend class CudaLaunch;

    struct Launch {
        std::string_view name;
        CallSite where;
    };

    /// Records a launch and throws if it was refused.
    void launched(std::string_view name, CallSite where) const;
    /// @throws DeviceError "WHAT 'NAME' on CUDA device 0 (...): REASON" unless the status is good.
    void require(cuda::Status status, std::string_view what, std::string_view name = {}) const;
    /// Description "kernel 'a' (file.cu:7)", or the last of several.
    std::string pending_kernels() const;

    CudaDevice device_;
    Checks checks_;
    CUstream_st* stream_ = nullptr;
    std::shared_ptr<Memory> memory_ = std::make_shared<Memory>();

    // Kernels since the last wait: their number, and the last of them in a ring.
    mutable std::array<Launch, 4> launches_;
    mutable long launch_count_ = 0;
};

/// Launch of one kernel (parallel.cuh). Makes the space's device that of this thread; done() checks.
class CudaLaunch {
public:
    /// @param name  a literal, as of stages: the space keeps a view of it
    CudaLaunch(const CudaSpace& space, std::string_view name, CallSite where)
        : space_(space), name_(name), where_(where)
    {
        space.require(cuda::use_device(space.device().index), "choosing the device");
    }
    /// @throws DeviceError naming kernel, file and line if the launch was refused.
    void done() const { space_.launched(name_, where_); }

private:
    const CudaSpace& space_;
    std::string_view name_;
    CallSite where_;
};

} // namespace toile
