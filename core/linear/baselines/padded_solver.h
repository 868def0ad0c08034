#pragma once

#include <vector>

#include "core/linear/global_solver.h"

namespace toile {

/// x, y, z and a lane of zeros: one register, so that each entry of a matrix is one multiply-add.
using Vec4 = Eigen::Vector4d;

/// 1 / diagonal [n]; 0 at fixed vertices, which takes them out of every method that scales by it: their
/// right-hand side, search directions and corrections stay zero.
/// @throws InvalidInput naming the first row whose diagonal is not positive
std::vector<double> invert_diagonal(const SparseMatrix& A, View<const unsigned char> fixed);

/// H without the zeros that fixed vertices leave in its pattern, compressed.
SparseMatrix without_zeros(const SparseMatrix& H);

/// What the baselines of the global step share: they keep their own copy of H without the zeros that fixed
/// vertices leave in its pattern, work on padded fields, and hand b through at fixed vertices bit for bit.
///
/// One solve at a time: scratch belongs to the solver. Positive definiteness is checked as far as the method
/// looks; InvalidInput may therefore come late or not at all for an indefinite H with a positive diagonal.
class PaddedSolver : public GlobalSolver {
public:
    void update(const SparseMatrix& H, View<const unsigned char> fixed) final;
    void solve(View<const Vec3> b, View<Vec3> x) const final;

protected:
    /// Everything is rebuilt, for the same pattern too: no baseline is measured by its setup.
    /// @param A                 [n x n] H, compressed, without explicit zeros
    /// @param inverse_diagonal  [n] see invert_diagonal()
    virtual void prepare(const SparseMatrix& A, std::vector<double> inverse_diagonal) = 0;

    /// x = A^-1 b or close to it.
    /// @param b  [n] zero at fixed vertices
    /// @param x  [n] another array than b; what it holds at fixed vertices is ignored
    virtual void solve_free(View<const Vec4> b, View<Vec4> x) const = 0;

private:
    std::vector<unsigned char> fixed_;
    mutable std::vector<Vec4> b_, x_;
};

} // namespace toile
