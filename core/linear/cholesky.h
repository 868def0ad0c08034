#pragma once

#include <memory>

#include "core/linear/sparse_matrix.h"
#include "core/linear/supernodal_factor.h"

namespace toile {

/// Sparse Cholesky factorisation A = P^T L L^T P of a symmetric positive definite matrix, for right-hand
/// sides of 3-vectors.
///
/// CHOLMOD orders (METIS nested dissection) and factors. The solves run on a row-major copy of its supernodes
/// with x, y and z in one SIMD register: several times faster than CHOLMOD's three-column solve.
class Cholesky {
public:
    /// Orders and factors A. O(n^1.5) time for surfaces, O(n log n) memory.
    /// @param A  compressed
    /// @throws InvalidInput if A is not positive definite, naming the first bad pivot.
    explicit Cholesky(const SparseMatrix& A);
    ~Cholesky();
    Cholesky(Cholesky&&) noexcept;
    Cholesky& operator=(Cholesky&&) noexcept;

    /// Factors another matrix of the same pattern, keeping the ordering.
    void refactor(const SparseMatrix& A);

    /// x = A^-1 b. Safe to call from several threads; each allocates its scratch once.
    /// @param b, x  [n]; may be the same array
    void solve(View<const Vec3> b, View<Vec3> x) const;

    const SupernodalFactor& factor() const { return *factor_; }
    /// Factor to be kept beyond the next refactor(), which does not change it.
    std::shared_ptr<const SupernodalFactor> shared_factor() const { return factor_; }

    int size() const;
    /// Entries of L, explicit zeros of the supernodes included.
    long factor_entries() const;

private:
    struct Cholmod;
    std::unique_ptr<Cholmod> cholmod_;
    std::shared_ptr<const SupernodalFactor> factor_;
};

} // namespace toile
