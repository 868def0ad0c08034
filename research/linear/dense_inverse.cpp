#include "research/linear/dense_inverse.h"

#include <string>

#include "core/base/error.h"
#include "core/compute/parallel.h"

namespace toile::research {

namespace {

/// Rows per task; a row is as long as the matrix is wide.
constexpr int kRowGrain = 16;

} // namespace

DenseInverse::DenseInverse(const SparseMatrix& A)
{
    if (A.rows() == 0) // no vertex is coupled to another, or all are fixed
        return;
    const Eigen::LLT<Eigen::MatrixXd> factor{Eigen::MatrixXd(A)};
    if (factor.info() != Eigen::Success)
        throw InvalidInput("matrix is not positive definite: its coarse " + std::to_string(A.rows()) + " x " +
                           std::to_string(A.rows()) + " form has no Cholesky factor");
    const Eigen::MatrixXd inverse = factor.solve(Eigen::MatrixXd::Identity(A.rows(), A.rows()));
    inverse_ = 0.5 * (inverse + inverse.transpose());
}

void DenseInverse::solve(View<const Vec4> b, View<Vec4> x) const
{
    using Columns = Eigen::Matrix<double, 4, Eigen::Dynamic>;
    const Eigen::Map<const Columns, alignof(Vec4)> all_b(b.data()->data(), 4, b.size());
    parallel_for(
        kCpu, "baselines/dense", b.size(), [&](int i) { x[i].noalias() = all_b * inverse_.col(i); },
        kRowGrain);
}

} // namespace toile::research
