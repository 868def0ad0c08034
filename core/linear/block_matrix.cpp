#include "core/linear/block_matrix.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile {

BlockMatrix::BlockMatrix(int rows, const std::vector<std::pair<int, int>>& couplings)
{
    std::vector<std::pair<int, int>> entries;
    entries.reserve(rows + 2 * couplings.size());
    for (int i = 0; i < rows; ++i)
        entries.emplace_back(i, i);
    for (const auto& [i, j] : couplings) {
        TOILE_ASSERT(i >= 0 && i < rows && j >= 0 && j < rows);
        entries.emplace_back(i, j);
        entries.emplace_back(j, i);
    }
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());

    first_.assign(rows + 1, 0);
    for (const auto& [i, j] : entries) {
        if (i == j)
            diagonal_.push_back(int(columns_.size()));
        columns_.push_back(j);
        first_[i + 1] = int(columns_.size());
    }
    blocks_.assign(columns_.size(), Mat3::Zero());
}

void BlockMatrix::set_zero()
{
    parallel_for(
        kCpu, "linear/zero_blocks", int(blocks_.size()), [&](int k) { blocks_[k].setZero(); }, 4096);
}

int BlockMatrix::position(int row, int column) const
{
    const auto begin = columns_.begin() + first_[row], end = columns_.begin() + first_[row + 1];
    const auto found = std::lower_bound(begin, end, column);
    TOILE_ASSERT(found != end && *found == column);
    return int(found - begin);
}

} // namespace toile
