#pragma once

/// Small vector types, borrowed arrays and the host/device marker that every folder shares.

#include <Eigen/Core>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "core/base/assert.h"

/// Marks a function that runs on the CPU and, in a CUDA build, on the GPU from the same source.
#ifdef __CUDACC__
#define TOILE_HD __host__ __device__
#else
#define TOILE_HD
#endif

namespace toile {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Mat32 = Eigen::Matrix<double, 3, 2>;
using Triangle = Eigen::Vector3i; ///< vertex indices, counter-clockwise seen from outside

/// Borrowed, contiguous array, which kernels and interfaces take. Never owns, never allocates.
template <typename T>
class View {
public:
    View() = default;
    TOILE_HD View(T* data, int size) : data_(data), size_(size) {}

    /// Borrows a vector; a View<const T> also borrows a vector of T.
    View(std::vector<std::remove_const_t<T>>& values) : data_(values.data()), size_(int(values.size())) {}
    template <typename U = T, typename = std::enable_if_t<std::is_const_v<U>>>
    View(const std::vector<std::remove_const_t<T>>& values) : data_(values.data()), size_(int(values.size()))
    {
    }
    template <typename U = T, typename = std::enable_if_t<std::is_const_v<U>>>
    TOILE_HD View(const View<std::remove_const_t<T>>& other) : data_(other.data()), size_(other.size())
    {
    }

    TOILE_HD T& operator[](int i) const
    {
        TOILE_ASSERT(i >= 0 && i < size_);
        return data_[i];
    }
    TOILE_HD T* data() const { return data_; }
    TOILE_HD int size() const { return size_; }
    TOILE_HD bool empty() const { return size_ == 0; }
    TOILE_HD T* begin() const { return data_; }
    TOILE_HD T* end() const { return data_ + size_; }

    /// Items [first, first + count).
    TOILE_HD View subview(int first, int count) const
    {
        TOILE_ASSERT(first >= 0 && count >= 0 && first + count <= size_);
        return View(data_ + first, count);
    }

private:
    T* data_ = nullptr;
    int size_ = 0;
};

} // namespace toile
