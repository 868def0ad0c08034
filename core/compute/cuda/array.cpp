#include "core/compute/cuda/array.h"

#include "core/base/error.h"

namespace toile {

using cuda::Status;

CudaBuffer::CudaBuffer(const CudaSpace& space, Where where, std::string name)
    : space_(&space), where_(where), name_(std::move(name))
{
}

CudaBuffer::~CudaBuffer() { release(); }

CudaBuffer::CudaBuffer(CudaBuffer&& other) noexcept
    : space_(other.space_), where_(other.where_), name_(std::move(other.name_)),
      data_(std::exchange(other.data_, nullptr)), capacity_(std::exchange(other.capacity_, 0))
{
}

CudaBuffer& CudaBuffer::operator=(CudaBuffer&& other) noexcept
{
    if (this == &other)
        return *this;
    release();
    space_ = other.space_;
    where_ = other.where_;
    name_ = std::move(other.name_);
    data_ = std::exchange(other.data_, nullptr);
    capacity_ = std::exchange(other.capacity_, 0);
    return *this;
}

void CudaBuffer::reserve(std::size_t bytes, std::size_t kept)
{
    if (bytes <= capacity_)
        return;
    if (space_->is_recording())
        throw DeviceError("'" + name_ + "' would have to grow from " + std::to_string(capacity_) + " to " +
                          std::to_string(bytes) +
                          " bytes while a graph is recorded; give it its size before");

    // Grow by half at least, so that slowly growing sizes allocate rarely; if that is too much, by what is
    // needed.
    void* data = nullptr;
    std::size_t capacity = std::max(bytes, capacity_ + capacity_ / 2);
    if (kept == 0)
        release();
    try {
        data = allocate(capacity);
    } catch (const DeviceError&) {
        if (capacity == bytes)
            throw;
        capacity = bytes;
        data = allocate(capacity);
    }

    if (kept > 0) {
        const Status copied = cuda::copy(space_->device().index, space_->stream(),
                                         cuda::Direction::DeviceToDevice, data, data_, kept);
        release(); // waits for the copy
        data_ = data;
        capacity_ = capacity;
        space_->require(copied, "growing", name_);
    }
    data_ = data;
    capacity_ = capacity;
}

void* CudaBuffer::allocate(std::size_t bytes) const
{
    const int device = space_->device().index;
    void* data = nullptr;
    const Status status = where_ == Where::Device ? cuda::allocate(device, bytes, data)
                                                  : cuda::allocate_pinned(device, bytes, data);
    if (status != Status::Good)
        refuse(bytes, status);
    CudaSpace::Memory& memory = *space_->memory_;
    ++memory.allocations;
    (where_ == Where::Device ? memory.device_bytes : memory.pinned_bytes) += bytes;
#ifdef TOILE_CHECKED
    // Fill with NaN, so that a number read before it is written shows.
    if (where_ == Where::Device)
        space_->require(cuda::fill(device, space_->stream(), data, 0xff, bytes), "filling", name_);
#endif
    return data;
}

void CudaBuffer::refuse(std::size_t bytes, Status status) const
{
    const auto mebibytes = [](std::size_t count) { return std::to_string((count + (1 << 20) - 1) >> 20); };
    const std::string asked = "'" + name_ + "' asked for " + mebibytes(bytes) + " MiB";
    std::size_t free = 0, total = 0;
    const bool known = cuda::memory_left(space_->device().index, free, total) == Status::Good;
    if (where_ == Where::Device && known && cuda::is_out_of_memory(status))
        throw DeviceError(space_->described() + " is out of memory: " + asked + ", " + mebibytes(free) +
                          " of " + mebibytes(total) + " MiB are free");
    space_->require(status, asked + (where_ == Where::Pinned ? " of pinned host memory" : ""));
    throw DeviceError(asked); // not reached: the status is not good
}

void CudaBuffer::release() noexcept
{
    if (data_ == nullptr)
        return;
    const int device = space_->device().index;
    // Work in flight may still use the memory. A device that no longer responds keeps it.
    static_cast<void>(cuda::wait_for(device, space_->stream()));
    static_cast<void>(where_ == Where::Device ? cuda::release(device, data_)
                                              : cuda::release_pinned(device, data_));
    CudaSpace::Memory& memory = *space_->memory_;
    (where_ == Where::Device ? memory.device_bytes : memory.pinned_bytes) -= capacity_;
    data_ = nullptr;
    capacity_ = 0;
}

void CudaBuffer::upload(const void* from, std::size_t bytes)
{
    if (bytes > 0)
        space_->require(cuda::copy(space_->device().index, space_->stream(), cuda::Direction::HostToDevice,
                                   data_, from, bytes),
                        "upload into", name_);
}

void CudaBuffer::download(void* to, std::size_t bytes) const
{
    if (bytes > 0)
        space_->require(cuda::copy(space_->device().index, space_->stream(), cuda::Direction::DeviceToHost,
                                   to, data_, bytes),
                        "download of", name_);
}

void CudaBuffer::fill_zero(std::size_t bytes)
{
    if (bytes > 0)
        space_->require(cuda::fill(space_->device().index, space_->stream(), data_, 0, bytes), "zeroing",
                        name_);
}

} // namespace toile
