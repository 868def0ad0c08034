#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include <Eigen/Eigenvalues>

#include "core/pd/energy/curvature.h"

/// True Hessians of energies compared with differences of their gradients.
namespace toile::test {

/// Isotropic part and blocks as one dense matrix.
inline Eigen::MatrixXd dense_hessian(const std::shared_ptr<Energy>& energy, const std::vector<Vec3>& x,
                                     Definiteness definiteness)
{
    const int n = int(x.size());
    Curvature curvature(n, {energy});
    curvature.assemble(x, definiteness);
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int i = 0; i < n; ++i) {
        for (SparseMatrix::InnerIterator entry(curvature.isotropic(), i); entry; ++entry)
            H.block<3, 3>(3 * i, 3 * entry.col()).diagonal().array() += entry.value();
        for (int k = 0; k < curvature.blocks().columns(i).size(); ++k)
            H.block<3, 3>(3 * i, 3 * curvature.blocks().columns(i)[k]) += curvature.blocks().blocks(i)[k];
    }
    return H;
}

inline Eigen::MatrixXd differences_of_gradient(Energy& energy, std::vector<Vec3> x)
{
    const double step = 1e-6;
    const int n = int(x.size());
    Eigen::MatrixXd H(3 * n, 3 * n);
    for (int j = 0; j < 3 * n; ++j) {
        std::vector<Vec3> up(n, Vec3::Zero()), down(n, Vec3::Zero());
        const double here = x[j / 3][j % 3];
        x[j / 3][j % 3] = here + step;
        energy.add_gradient(x, up);
        x[j / 3][j % 3] = here - step;
        energy.add_gradient(x, down);
        x[j / 3][j % 3] = here;
        for (int i = 0; i < 3 * n; ++i)
            H(i, j) = (up[i / 3][i % 3] - down[i / 3][i % 3]) / (2.0 * step);
    }
    return H;
}

inline double smallest_eigenvalue(const Eigen::MatrixXd& H)
{
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(H, Eigen::EigenvaluesOnly).eigenvalues()[0];
}

inline void expect_exact(const std::shared_ptr<Energy>& energy, const std::vector<Vec3>& x)
{
    const Eigen::MatrixXd H = dense_hessian(energy, x, Definiteness::Exact);
    const double scale = H.cwiseAbs().maxCoeff();
    ASSERT_GT(scale, 0.0);
    EXPECT_LT((H - differences_of_gradient(*energy, x)).cwiseAbs().maxCoeff(), 1e-6 * scale);
    EXPECT_LT((H - H.transpose()).cwiseAbs().maxCoeff(), 1e-13 * scale);
}

inline void expect_semidefinite(const std::shared_ptr<Energy>& energy, const std::vector<Vec3>& x)
{
    const Eigen::MatrixXd H = dense_hessian(energy, x, Definiteness::Projected);
    EXPECT_GT(smallest_eigenvalue(H), -1e-12 * H.cwiseAbs().maxCoeff());
}

} // namespace toile::test
