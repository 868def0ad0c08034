#pragma once

#include <vector>

#include "core/linear/global_solver.h"

namespace toile {

/// x, y, z and a zero: one register, so that each entry of a matrix is one multiply-add.
using Vec4 = Eigen::Vector4d;

/// Entries 1 / diagonal [n]; 0 at fixed vertices. The zero excludes them from every method that scales by it:
/// their right-hand side, search directions and corrections stay zero.
/// @throws InvalidInput naming the first row whose diagonal is not positive
std::vector<double> invert_diagonal(const SparseMatrix& A, View<const unsigned char> fixed);

/// H without the zeros that fixed vertices leave in its pattern, compressed.
SparseMatrix without_zeros(const SparseMatrix& H);

/// Base of the baselines of the global step. They copy H without the zeros that fixed vertices leave in
/// its pattern and use padded fields. At fixed vertices they copy b bit for bit.
///
/// One solve at a time, because the solver owns its scratch. Positive definiteness is checked only as far as
/// the method goes. InvalidInput may therefore come late or not at all for an indefinite H with a positive
/// diagonal.
class PaddedSolver : public GlobalSolver {
public:
    void update(const SparseMatrix& H, View<const unsigned char> fixed) final;
    void solve(View<const Vec3> b, View<Vec3> x) const final;

protected:
    /// Rebuilds everything, even for the same pattern: setup does not count in comparisons of baselines.
    /// @param A                 [n x n] H, compressed, without explicit zeros
    /// @param inverse_diagonal  [n] see invert_diagonal()
    virtual void prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal) = 0;

    /// Computes x = A^-1 b, approximately.
    /// @param b  [n] zero at fixed vertices
    /// @param x  [n] another array than b; its values at fixed vertices are ignored
    virtual void solve_free(View<const Vec4> b, View<Vec4> x) const = 0;

private:
    std::vector<unsigned char> fixed_;
    mutable std::vector<Vec4> b_, x_;
};

} // namespace toile
