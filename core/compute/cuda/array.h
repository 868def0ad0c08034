#pragma once

#include <algorithm>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/compute/cuda/runtime/device.h"
#include "core/compute/types.h"

namespace toile {

/// Bytes on a device, or on the host where the device can read and write them directly ("pinned"): the
/// storage of DeviceArray and PinnedArray.
///
/// Memory comes from cudaMalloc, not from the stream-ordered pool. Arrays grow while a run warms up and not
/// in its steps, so the pool's speed buys nothing; and cudaMalloc refuses at once, in the call that asked.
/// Growing or freeing waits for the stream, so a running kernel never loses its data. Before another space
/// works on an array, the caller waits for that space.
class CudaBuffer {
public:
    enum class Where { Device, Pinned };

    /// Allocates nothing yet.
    /// @param name  in errors
    CudaBuffer(const CudaSpace& space, Where where, std::string name);
    ~CudaBuffer();
    CudaBuffer(CudaBuffer&& other) noexcept;
    CudaBuffer& operator=(CudaBuffer&& other) noexcept;

    /// Reserves a capacity of `bytes` and keeps the first `kept` of the contents. Never shrinks.
    /// @throws DeviceError naming the array, what was asked and what is free; or that a graph is being
    ///         recorded, which allows no growing
    void reserve(std::size_t bytes, std::size_t kept);

    /// Enqueues an upload without waiting for it; the next two functions likewise.
    void upload(const void* from, std::size_t bytes);
    void download(void* to, std::size_t bytes) const;
    void fill_zero(std::size_t bytes);

    void* data() const { return data_; }
    const CudaSpace& space() const { return *space_; }

private:
    void* allocate(std::size_t bytes) const;
    void release() noexcept;
    [[noreturn]] void refuse(std::size_t bytes, cuda::Status status) const;

    const CudaSpace* space_;
    Where where_;
    std::string name_;
    void* data_ = nullptr;
    std::size_t capacity_ = 0; ///< [bytes]
};

/// True for types whose bytes are their value. Eigen's fixed sizes qualify, though their copy constructors
/// are not trivial by the letter; so the test is that nothing is owned and nothing virtual.
template <typename T>
inline constexpr bool kIsPlainData = std::is_trivially_destructible_v<T> && !std::is_polymorphic_v<T>;

/// Array on a GPU. Its view() is for kernels: the host can't read through it.
template <typename T>
class DeviceArray {
    static_assert(kIsPlainData<T>, "arrays on a device are copied byte by byte");

public:
    /// @param name  in errors, e.g. "membrane/corner_gradient"
    DeviceArray(const CudaSpace& space, std::string name, int size = 0)
        : buffer_(space, CudaBuffer::Where::Device, std::move(name))
    {
        resize(size);
    }

    /// Discards the contents. Allocates only above the largest size so far.
    /// @throws DeviceError if the device has not that much left
    void resize(int size)
    {
        size_ = 0; // size if reserve() throws
        buffer_.reserve(bytes(size), 0);
        size_ = size;
    }
    /// Keeps the first min(size(), size) items; new items are undefined.
    void resize_keeping(int size)
    {
        buffer_.reserve(bytes(size), bytes(std::min(size, size_)));
        size_ = size;
    }

    /// Copies `values` into the array. They may be freed or changed when the call returns, unless they lie in
    /// a PinnedArray: those are read later, in stream order.
    void upload(View<const T> values)
    {
        resize(values.size());
        buffer_.upload(values.data(), bytes(size_));
    }
    /// Copies all items to `values` [size()]. A PinnedArray is written in stream order (synchronise before
    /// reading), other memory before the call returns.
    void download(View<T> values) const
    {
        TOILE_ASSERT(values.size() == size_);
        buffer_.download(values.data(), bytes(size_));
    }
    /// Copies the first values.size() items likewise.
    void download_first(View<T> values) const
    {
        TOILE_ASSERT(values.size() <= size_);
        buffer_.download(values.data(), bytes(values.size()));
    }
    /// Copy of all items; waits for the device.
    std::vector<T> downloaded() const
    {
        std::vector<T> values(size_);
        download(View<T>(values.data(), size_));
        buffer_.space().synchronise();
        return values;
    }

    /// Sets every byte to 0: zeros of numbers.
    void fill_zero() { buffer_.fill_zero(bytes(size_)); }

    int size() const { return size_; }
    View<T> view() { return View<T>(static_cast<T*>(buffer_.data()), size_); }
    View<const T> view() const { return View<const T>(static_cast<const T*>(buffer_.data()), size_); }

private:
    static std::size_t bytes(int size) { return std::size_t(size) * sizeof(T); }

    CudaBuffer buffer_;
    int size_ = 0;
};

/// Array on the host that a device copies from and to without staging, in stream order.
template <typename T>
class PinnedArray {
    static_assert(kIsPlainData<T>, "nothing constructs the items");

public:
    PinnedArray(const CudaSpace& space, std::string name, int size = 0)
        : buffer_(space, CudaBuffer::Where::Pinned, std::move(name))
    {
        resize(size);
    }

    /// Discards the contents. Waits for the stream if it has to grow.
    void resize(int size)
    {
        size_ = 0;
        buffer_.reserve(std::size_t(size) * sizeof(T), 0);
        size_ = size;
    }

    int size() const { return size_; }
    View<T> view() { return View<T>(static_cast<T*>(buffer_.data()), size_); }
    View<const T> view() const { return View<const T>(static_cast<const T*>(buffer_.data()), size_); }
    T& operator[](int i) { return view()[i]; }
    const T& operator[](int i) const { return view()[i]; }

private:
    CudaBuffer buffer_;
    int size_ = 0;
};

} // namespace toile
