#include "core/linear/sparse_matrix.h"

#include <numeric>
#include <string>

#include "core/base/error.h"

namespace toile {

Hash128 hash_of(const SparseMatrix& A)
{
    TOILE_ASSERT(A.isCompressed());
    Hasher hasher;
    hasher.add(View<const int>(A.outerIndexPtr(), int(A.outerSize()) + 1));
    hasher.add(View<const int>(A.innerIndexPtr(), int(A.nonZeros())));
    hasher.add(View<const double>(A.valuePtr(), int(A.nonZeros())));
    return hasher.result();
}

std::vector<int> consecutive_rows(int first, int count)
{
    std::vector<int> rows(count);
    std::iota(rows.begin(), rows.end(), first);
    return rows;
}

SparseMatrix diagonal_block(const SparseMatrix& H, View<const int> rows)
{
    Eigen::VectorXi counts(rows.size());
    for (int i = 0; i < rows.size(); ++i)
        counts[i] = H.outerIndexPtr()[rows[i] + 1] - H.outerIndexPtr()[rows[i]];
    SparseMatrix block(rows.size(), rows.size());
    block.reserve(counts);
    for (int i = 0; i < rows.size(); ++i)
        for (SparseMatrix::InnerIterator entry(H, rows[i]); entry; ++entry) {
            const int* const column = std::lower_bound(rows.begin(), rows.end(), int(entry.col()));
            if (column == rows.end() || *column != entry.col())
                throw InvalidInput("row " + std::to_string(rows[i]) + " of H is coupled to row " +
                                   std::to_string(entry.col()) + " of another block");
            block.insert(i, int(column - rows.begin())) = entry.value();
        }
    block.makeCompressed();
    return block;
}

} // namespace toile
