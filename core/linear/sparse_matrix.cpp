#include "core/linear/sparse_matrix.h"

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

SparseMatrix diagonal_block(const SparseMatrix& H, int first, int size)
{
    Eigen::VectorXi counts(size);
    for (int i = 0; i < size; ++i)
        counts[i] = H.outerIndexPtr()[first + i + 1] - H.outerIndexPtr()[first + i];
    SparseMatrix block(size, size);
    block.reserve(counts);
    for (int i = 0; i < size; ++i)
        for (SparseMatrix::InnerIterator entry(H, first + i); entry; ++entry) {
            const int column = int(entry.col()) - first;
            if (column < 0 || column >= size)
                throw InvalidInput("row " + std::to_string(first + i) + " of H is coupled to row " +
                                   std::to_string(entry.col()) + " of another block");
            block.insert(i, column) = entry.value();
        }
    block.makeCompressed();
    return block;
}

} // namespace toile
