#include "core/linear/supernodal_factor.h"

#include <algorithm>

namespace toile {

namespace {

using Vec4 = Eigen::Vector4d;

/// Rows or columns treated together: eight accumulators fill the registers and hide the latency of the
/// multiply-adds.
constexpr int kBlock = 8;

/// acc[k] = sum_j L(k, j) y[j] for `Count` rows of length `width`, `stride` apart.
template <int Count>
void multiply_rows(const double* L, int stride, int width, const Vec4* y, Vec4* acc)
{
    Vec4 sum[Count];
    for (int k = 0; k < Count; ++k)
        sum[k].setZero();
    for (int j = 0; j < width; ++j)
        for (int k = 0; k < Count; ++k)
            sum[k] += L[long(k) * stride + j] * y[j];
    for (int k = 0; k < Count; ++k)
        acc[k] = sum[k];
}

/// acc[k] = sum_r L(r, k) y[r] for `Count` columns starting at L, rows `stride` apart.
template <int Count>
void multiply_columns(const double* L, int stride, int row_count, const Vec4* y, Vec4* acc)
{
    Vec4 sum[Count];
    for (int k = 0; k < Count; ++k)
        sum[k].setZero();
    for (int r = 0; r < row_count; ++r)
        for (int k = 0; k < Count; ++k)
            sum[k] += L[long(r) * stride + k] * y[r];
    for (int k = 0; k < Count; ++k)
        acc[k] = sum[k];
}

/// L y = b on one supernode: the triangle first, then its share of the rows below.
void forward(const SupernodalFactor::Supernode& node, const int* rows, const double* L, Vec4* y)
{
    const int width = node.width;
    Vec4* own = y + node.first_column;
    for (int i = 0; i < width; ++i) {
        const double* row = L + long(i) * width;
        Vec4 sum = own[i];
        for (int j = 0; j < i; ++j)
            sum -= row[j] * own[j];
        own[i] = row[i] * sum;
    }

    const double* below = L + long(width) * width;
    Vec4 acc[kBlock];
    int r = 0;
    for (; r + kBlock <= node.row_count; r += kBlock) {
        multiply_rows<kBlock>(below + long(r) * width, width, width, own, acc);
        for (int k = 0; k < kBlock; ++k)
            y[rows[r + k]] -= acc[k];
    }
    for (; r < node.row_count; ++r) {
        multiply_rows<1>(below + long(r) * width, width, width, own, acc);
        y[rows[r]] -= acc[0];
    }
}

/// L^T x = y on one supernode: subtract what the rows below contribute, then the transposed triangle.
/// @param gathered  scratch for the values of the rows below [row_count]
void backward(const SupernodalFactor::Supernode& node, const int* rows, const double* L, Vec4* y,
              Vec4* gathered)
{
    const int width = node.width;
    Vec4* own = y + node.first_column;
    for (int r = 0; r < node.row_count; ++r)
        gathered[r] = y[rows[r]];

    const double* below = L + long(width) * width;
    Vec4 acc[kBlock];
    int j = 0;
    for (; j + kBlock <= width; j += kBlock) {
        multiply_columns<kBlock>(below + j, width, node.row_count, gathered, acc);
        for (int k = 0; k < kBlock; ++k)
            own[j + k] -= acc[k];
    }
    for (; j < width; ++j) {
        multiply_columns<1>(below + j, width, node.row_count, gathered, acc);
        own[j] -= acc[0];
    }

    for (int i = width - 1; i >= 0; --i) {
        Vec4 sum = own[i];
        for (int k = i + 1; k < width; ++k)
            sum -= L[long(k) * width + i] * own[k];
        own[i] = L[long(i) * width + i] * sum;
    }
}

/// Scratch of the calling thread, grown once: a solve allocates nothing after the first.
Vec4* scratch(size_t count)
{
    thread_local std::vector<Vec4, Eigen::aligned_allocator<Vec4>> memory;
    if (memory.size() < count)
        memory.resize(count);
    return memory.data();
}

} // namespace

void SupernodalFactor::solve(View<const Vec3> b, View<Vec3> x) const
{
    const int n = int(permutation.size());
    Vec4* y = scratch(2 * size_t(n));
    Vec4* gathered = y + n;
    for (int k = 0; k < n; ++k)
        y[k] << b[permutation[k]], 0.0;
    for (const Supernode& node : supernodes)
        forward(node, rows.data() + node.first_row, values.data() + node.first_value, y);
    for (auto node = supernodes.rbegin(); node != supernodes.rend(); ++node)
        backward(*node, rows.data() + node->first_row, values.data() + node->first_value, y, gathered);
    for (int k = 0; k < n; ++k)
        x[permutation[k]] = y[k].head<3>();
}

} // namespace toile
