#include "core/pd/cuda/newton/hessian_pattern.h"

#include <algorithm>

#include "core/compute/team.h"

namespace toile {

namespace {

/// Columns of the entries beside the diagonal.
std::vector<std::vector<int>> columns_of(const BlockMatrix& matrix)
{
    std::vector<std::vector<int>> columns(matrix.rows());
    for (int row = 0; row < matrix.rows(); ++row)
        for (const int column : matrix.columns(row))
            if (column != row)
                columns[row].push_back(column);
    return columns;
}

std::vector<std::vector<int>> columns_of(const SparseMatrix& matrix)
{
    std::vector<std::vector<int>> columns(matrix.rows());
    for (int row = 0; row < int(matrix.rows()); ++row)
        for (SparseMatrix::InnerIterator entry(matrix, row); entry; ++entry)
            if (entry.col() != row)
                columns[row].push_back(int(entry.col()));
    return columns;
}

} // namespace

SlicedPattern::SlicedPattern(const std::vector<std::vector<int>>& columns) : first_{0}
{
    const int rows = int(columns.size());
    for (int begin = 0; begin < rows; begin += kWarp) {
        int longest = 0;
        for (int row = begin; row < std::min(begin + kWarp, rows); ++row)
            longest = std::max(longest, int(columns[row].size()));
        for (int k = 0; k < longest; ++k)
            for (int row = begin; row < begin + kWarp; ++row) {
                const int existing = std::min(row, rows - 1);
                columns_.push_back(k < int(columns[existing].size()) ? columns[existing][k] : existing);
            }
        first_.push_back(int(columns_.size()));
    }
    for (const std::vector<int>& row : columns)
        length_.push_back(int(row.size()));
}

int SlicedPattern::position(int row, int column) const
{
    const int begin = first_[row / kWarp] + row % kWarp;
    int low = 0, high = length_[row];
    while (low < high) {
        const int middle = (low + high) / 2;
        if (columns_[begin + middle * kWarp] < column)
            low = middle + 1;
        else
            high = middle;
    }
    const int found = begin + low * kWarp;
    return low < length_[row] && columns_[found] == column ? found : -1;
}

HessianPattern::HessianPattern(const BlockMatrix& blocks, const SparseMatrix& isotropic)
    : blocks_(columns_of(blocks)), scalars_(columns_of(isotropic)), constant_(scalars_.size(), 0.0F)
{
    for (int row = 0; row < int(isotropic.rows()); ++row)
        for (SparseMatrix::InnerIterator entry(isotropic, row); entry; ++entry)
            if (entry.col() != row)
                constant_[scalar_position(row, int(entry.col()))] = float(entry.value());
}

} // namespace toile
