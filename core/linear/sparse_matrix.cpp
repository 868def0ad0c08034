#include "core/linear/sparse_matrix.h"

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

} // namespace toile
