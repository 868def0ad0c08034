#pragma once

#include <Eigen/SparseCholesky>

#include "core/pd/preconditioner/block_inverse.h"
#include "core/pd/preconditioner/coupled_part.h"

namespace toile {

/// E = (D + dH)^-1 up to rounding: a sparse Cholesky factor of the coupled vertices, 3x3 blocks for the
/// others. Reordered and refactored for every active set.
class ExactInverse : public ContactInverse {
public:
    void update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed) override;
    void apply(View<const Vec3> r, View<Vec3> z) const override;

private:
    BlockInverse uncoupled_;
    CoupledPart coupled_;
    Eigen::SimplicialLLT<Eigen::SparseMatrix<double>> factor_; ///< [3 coupled x 3 coupled]
    mutable Eigen::VectorXd numbers_;
};

} // namespace toile
