#include "research/methods/jgs2/jgs2.h"

#include <string>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/compute/parallel.h"
#include "core/linear/cholesky.h"

namespace toile::research {

namespace {

/// Closest rotation to F; of a plane's F, the one that turns its normal too.
Mat3 rotation_of(const Mat3& F)
{
    const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vec3 signs = Vec3::Ones();
    signs[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant();
    return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

} // namespace

void Jgs2::tabulate(Hessian& hessian)
{
    hessian.linearise(rest_, Definiteness::Projected);
    const HessianParts parts = hessian.parts();
    if (parts.inertia.size() != int(rest_.size()))
        throw InvalidInput("jgs2: " + std::to_string(rest_.size()) + " rest positions for " +
                           std::to_string(parts.inertia.size()) + " vertices");
    inertia_.assign(parts.inertia.begin(), parts.inertia.end());
    fixed_.assign(parts.fixed.begin(), parts.fixed.end());
    const SparseMatrix K = hessian.matrix();
    const Cholesky cholesky(K);
    const int n = int(rest_.size());
    std::vector<Vec3> columns(3 * size_t(n));
    for (int i = 0; i < n; ++i) {
        // Three columns of G at once.
        std::fill(columns.begin(), columns.end(), Vec3::Zero());
        for (int k = 0; k < 3; ++k)
            columns[3 * i + k] = Vec3::Unit(k);
        cholesky.solve(columns, columns);
        Eigen::MatrixX3d& u = subspace_.emplace_back(3 * n, 3);
        for (int row = 0; row < 3 * n; ++row)
            u.row(row) = columns[row].transpose();
        const Mat3 own = u.middleRows<3>(3 * i);
        u *= own.inverse();

        std::vector<int>& neighbours = neighbours_.emplace_back();
        for (SparseMatrix::InnerIterator entry(K, 3 * i); entry; ++entry)
            if (const int j = int(entry.col()) / 3; j != i && (neighbours.empty() || neighbours.back() != j))
                neighbours.push_back(j);
    }
}

void Jgs2::require_as_tabulated(const HessianParts& parts) const
{
    const auto refuse = [](const std::string& what) {
        throw InvalidInput("jgs2: " + what + "; make one object for each step length and set of fixed ones");
    };
    if (parts.inertia.size() != int(inertia_.size()))
        refuse("there are " + std::to_string(parts.inertia.size()) +
               " vertices, and the subspaces were made with " + std::to_string(inertia_.size()));
    for (int v = 0; v < parts.inertia.size(); ++v) {
        if ((parts.fixed[v] != 0) != (fixed_[size_t(v)] != 0))
            refuse("vertex " + std::to_string(v) + (parts.fixed[v] != 0 ? " is" : " is not") +
                   " fixed, and the subspaces were made with the opposite");
        if (parts.inertia[v] != inertia_[size_t(v)])
            refuse("vertex " + std::to_string(v) + " has the inertia " + short_text(parts.inertia[v]) +
                   " N/m, and the subspaces were made with " + short_text(inertia_[size_t(v)]) + " N/m");
    }
}

std::vector<Mat3> Jgs2::rotations(View<const Vec3> x) const
{
    std::vector<Mat3> R(rest_.size());
    parallel_for(kCpu, "jgs2/rotations", int(R.size()), [&](int i) {
        Mat3 F = Mat3::Zero();
        for (const int j : neighbours_[i])
            F += (x[j] - x[i]) * (rest_[j] - rest_[i]).transpose();
        R[i] = rotation_of(F);
    });
    return R;
}

void Jgs2::find_direction(Objective& objective, const Here& here, View<Vec3> direction)
{
    Hessian* const hessian = objective.hessian();
    if (hessian == nullptr)
        throw InvalidInput("jgs2: the objective has no second derivatives; choose another method");
    if (subspace_.empty())
        tabulate(*hessian);
    hessian->linearise(here.x, Definiteness::Projected);
    require_as_tabulated(hessian->parts());
    const SparseMatrix K = hessian->matrix();
    const std::vector<Mat3> R = rotations(here.x);
    const Eigen::Map<const Eigen::VectorXd> g(here.gradient.data()->data(), 3 * here.gradient.size());
    parallel_for(kCpu, "jgs2/directions", direction.size(), [&](int i) {
        Eigen::MatrixX3d U(3 * direction.size(), 3);
        for (int j = 0; j < direction.size(); ++j)
            U.middleRows<3>(3 * j) = R[j] * subspace_[i].middleRows<3>(3 * j) * R[i].transpose();
        const Mat3 reduced = U.transpose() * (K * U);
        direction[i] = -reduced.ldlt().solve(Vec3(U.transpose() * g));
    });
}

} // namespace toile::research
