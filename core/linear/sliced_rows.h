#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "core/compute/team.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

/// Entry of a sparse matrix: one load of 8 bytes on a GPU.
struct alignas(8) RowEntry {
    int column;
    float value;
};

/// Entries k, k + kWarp and so on of a row; zeros from `end` on. All of them are loaded before any is waited
/// for.
template <int Count>
TOILE_HD std::array<RowEntry, Count> entries_from(View<const RowEntry> entries, int row, int k, int end)
{
    std::array<RowEntry, Count> some;
    for (int n = 0; n < Count; ++n)
        some[n] = k + n * kWarp < end ? entries[k + n * kWarp] : RowEntry{row, 0.0F};
    return some;
}

/// Rows of a sparse matrix in slices, one for each warp. Each row has `Threads` threads, which take its
/// entries cyclically, so that a warp's loads are contiguous. All rows of a slice have the length of its
/// longest row, rounded up to whole warps of entries. Padding is 0 at the diagonal.
template <int Threads>
struct RowsInSlices {
    static constexpr int kThreads = Threads; ///< of a row
    static constexpr int kRows = kWarp / kThreads;

    std::vector<int> first; ///< [slices + 1] into entries
    std::vector<RowEntry> entries;

    /// @param row_first  [rows + 1] into columns and values
    RowsInSlices(View<const int> row_first, View<const int> columns, View<const float> values)
    {
        const int rows = row_first.size() - 1;
        first.push_back(0);
        for (int begin = 0; begin < rows; begin += kRows) {
            int longest = 0;
            for (int row = begin; row < std::min(begin + kRows, rows); ++row)
                longest = std::max(longest, row_first[row + 1] - row_first[row]);
            for (int offset = 0; offset < longest; offset += kThreads)
                for (int item = 0; item < kWarp; ++item) {
                    const int row = std::min(begin + item / kThreads, rows - 1);
                    const int k = row_first[row] + offset + item % kThreads;
                    entries.push_back(k < row_first[row + 1] ? RowEntry{columns[k], values[k]}
                                                             : RowEntry{row, 0.0F});
                }
            first.push_back(int(entries.size()));
        }
    }
};

using SlicedRows = RowsInSlices<4>;
using WholeRows = RowsInSlices<1>; ///< one thread per row: for kernels with much other work per row

/// @param A  compressed
template <typename Rows = SlicedRows>
Rows sliced_rows_of(const SparseMatrix& A)
{
    const std::vector<int> columns(A.innerIndexPtr(), A.innerIndexPtr() + A.nonZeros());
    const std::vector<float> values(A.valuePtr(), A.valuePtr() + A.nonZeros());
    return {View<const int>(A.outerIndexPtr(), int(A.rows()) + 1), columns, values};
}

} // namespace toile
