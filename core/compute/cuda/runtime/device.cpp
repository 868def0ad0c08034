#include "core/compute/cuda/runtime/device.h"

#include <algorithm>
#include <atomic>

#include "core/base/error.h"
#include "core/base/stages.h"

namespace toile {

namespace {

#ifdef TOILE_CHECKED
constexpr CudaSpace::Checks kDefaultChecks = CudaSpace::Checks::EveryLaunch;
#else
constexpr CudaSpace::Checks kDefaultChecks = CudaSpace::Checks::WhenSynchronised;
#endif

/// Device `index`, or DeviceError.
CudaDevice require_device(int index)
{
    const cuda::FoundDevices found = cuda::find_devices();
    const std::string prefix = "CUDA device " + std::to_string(index) + ": ";
    if (found.devices.empty())
        throw DeviceError(prefix + "there is none, because " + found.why_none);
    std::string list;
    for (const CudaDevice& device : found.devices) {
        if (device.index == index)
            return device;
        list += (list.empty() ? "" : ", ") + std::to_string(device.index) + " (" + device.name + ")";
    }
    throw DeviceError(prefix + "there is no such device; choose one of " + list);
}

std::string mebibytes(std::size_t bytes) { return std::to_string((bytes + (1 << 20) - 1) >> 20); }

std::string at(CallSite where) { return std::string(where.file) + ":" + std::to_string(where.line); }

} // namespace

std::vector<CudaDevice> cuda_devices() { return cuda::find_devices().devices; }
std::string why_no_cuda_device() { return cuda::find_devices().why_none; }

CudaSpace::CudaSpace(int device) : CudaSpace(device, kDefaultChecks) {}

CudaSpace::CudaSpace(int device, Checks checks) : device_(require_device(device)), checks_(checks)
{
    require(cuda::open_stream(device, stream_), "opening a stream");
}

CudaSpace::CudaSpace(const CudaSpace& other, Beside)
    : device_(other.device_), checks_(other.checks_), memory_(other.memory_)
{
    require(cuda::open_stream(device_.index, stream_), "opening a stream");
}

CudaSpace::~CudaSpace()
{
    // Errors are ignored: a device that no longer responds can't be helped.
    static_cast<void>(cuda::wait_for(device_.index, stream_));
    static_cast<void>(cuda::close_stream(device_.index, stream_));
}

void CudaSpace::synchronise(CallSite where) const
{
    if (is_recording())
        throw DeviceError(at(where) + ": nothing can be waited for while a graph is recorded on " +
                          described());
    const StageScope stage("cuda/wait");
    const cuda::Status status = cuda::wait_for(device_.index, stream_);
    if (status != cuda::Status::Good)
        throw DeviceError(pending_kernels() + " failed on " + described() + ": " + cuda::reason_of(status) +
                          "; noticed at " + at(where));
    launch_count_ = 0;
}

void CudaSpace::await(unsigned& word, unsigned value, CallSite where) const
{
    constexpr int kPolls = 1 << 14; // of the word, between queries of the stream
    const std::atomic_ref<unsigned> told(word);
    const auto has_come = [&] { return told.load(std::memory_order_acquire) == value; };
    if (has_come())
        return;
    const StageScope stage("cuda/wait");
    while (true) {
        for (int poll = 0; poll < kPolls; ++poll)
            if (has_come())
                return;
        const cuda::Status status = cuda::query_stream(device_.index, stream_);
        if (cuda::is_busy(status))
            continue;
        if (status != cuda::Status::Good)
            synchronise(where); // reports what failed
        if (!has_come())
            throw DeviceError(at(where) + ": nothing that was given to " + described() +
                              " sends the report that is waited for");
    }
}

std::size_t CudaSpace::free_memory() const
{
    std::size_t free = 0, total = 0;
    require(cuda::memory_left(device_.index, free, total), "asking for the memory left");
    return free;
}

void CudaSpace::require_memory(std::size_t bytes, std::string_view what) const
{
    if (const std::size_t free = free_memory(); bytes > free)
        throw DeviceError(described() + " is out of memory: " + std::string(what) + " " + mebibytes(bytes) +
                          " MiB, " + mebibytes(free) + " of " + mebibytes(device_.memory) + " MiB are free");
}

void CudaSpace::launched(std::string_view name, CallSite where) const
{
    const cuda::Status status = cuda::take_launch_error();
    if (status != cuda::Status::Good) {
        // An error of an earlier kernel shows here too.
        const std::string before = launch_count_ > 0 ? "; before it: " + pending_kernels() : "";
        throw DeviceError("kernel '" + std::string(name) + "' (" + at(where) + ") could not be launched on " +
                          described() + ": " + cuda::reason_of(status) + before);
    }
    if (is_recording())
        return;
    launches_[launch_count_ % long(launches_.size())] = {name, where};
    ++launch_count_;
    if (checks_ == Checks::EveryLaunch)
        synchronise(where);
}

void CudaSpace::require(cuda::Status status, std::string_view what, std::string_view name) const
{
    if (status == cuda::Status::Good)
        return;
    std::string message(what);
    if (!name.empty())
        message += " '" + std::string(name) + "'";
    message += " on " + described() + ": " + cuda::reason_of(status);
    throw DeviceError(message + (launch_count_ > 0 ? "; before it: " + pending_kernels() : ""));
}

std::string CudaSpace::described() const
{
    return "CUDA device " + std::to_string(device_.index) + " (" + device_.name + ")";
}

std::string CudaSpace::pending_kernels() const
{
    const long named = std::min(launch_count_, long(launches_.size()));
    if (named == 0)
        return "what was given";
    std::string list;
    for (long i = launch_count_ - named; i < launch_count_; ++i) {
        const Launch& launch = launches_[i % long(launches_.size())];
        list += (list.empty() ? "'" : ", '") + std::string(launch.name) + "' (" + at(launch.where) + ")";
    }
    if (launch_count_ == 1)
        return "kernel " + list;
    return "one of " + std::to_string(launch_count_) + " kernels, the last of them " + list + ",";
}

} // namespace toile
