#include "core/linear/cuda/batched_inverses.h"

#include <cmath>
#include <random>

#include <Eigen/Dense>

#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

/// Symmetric matrix with eigenvalues from 1e-3 to 1, and rows of very different size.
Eigen::MatrixXd random_spd(int size, unsigned seed)
{
    std::mt19937 random(seed);
    std::normal_distribution<double> value;
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(size, size, [&] { return value(random); });
    const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(A).householderQ();
    const Eigen::VectorXd eigenvalues = Eigen::VectorXd::NullaryExpr(
        size, [&](Eigen::Index k) { return std::pow(10.0, -3.0 * double(k) / size); });
    const Eigen::VectorXd scale =
        Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index k) { return std::pow(10.0, double(k % 5)); });
    return scale.asDiagonal() * Q * eigenvalues.asDiagonal() * Q.transpose() * scale.asDiagonal();
}

std::vector<Eigen::MatrixXd> inverses_of(BatchedInverses& inverses,
                                         const std::vector<Eigen::MatrixXd>& matrices)
{
    std::vector<double> entries(inverses.entries().size(), 0.0);
    for (size_t m = 0; m < matrices.size(); ++m) {
        const MatrixBatch::Matrix& at = inverses.matrices()[m];
        for (int i = 0; i < matrices[m].rows(); ++i)
            for (int j = 0; j < matrices[m].cols(); ++j)
                entries[at.first_entry + i * at.stride() + j] = matrices[m](i, j);
    }
    inverses.entries().upload(entries);
    inverses.invert();
    const std::vector<float> found = inverses.inverses().downloaded();
    std::vector<Eigen::MatrixXd> result;
    for (size_t m = 0; m < matrices.size(); ++m) {
        const MatrixBatch::Matrix& at = inverses.matrices()[m];
        result.emplace_back(matrices[m].rows(), matrices[m].cols());
        for (int i = 0; i < at.stride(); ++i)
            for (int j = 0; j < at.stride(); ++j) {
                const double value = found[at.first_entry + i * at.stride() + j];
                if (i < matrices[m].rows() && j < matrices[m].cols())
                    result[m](i, j) = value;
                else
                    EXPECT_EQ(value, 0.0) << "in the padding";
            }
    }
    return result;
}

} // namespace

using BatchedInversesTest = OnDevice;

TEST_F(BatchedInversesTest, InvertsMatricesOfAllSizesAtOnce)
{
    const std::vector<int> sizes{9, 144, 500, 1, 48, 49, 1152};
    BatchedInverses inverses(space(), sizes);
    std::vector<Eigen::MatrixXd> matrices;
    for (const int size : sizes)
        matrices.push_back(random_spd(size, unsigned(size)));
    // Rows that are the same as another one, or nearly so, and one without entries have no part in the
    // inverse.
    for (const int same : {400, 499}) {
        matrices[2].row(same) = matrices[2].row(7);
        matrices[2].col(same) = matrices[2].col(7);
        matrices[2](same, same) = matrices[2](7, 7);
    }
    matrices[2](400, 400) *= 1.0 + 1e-5;
    matrices[2].row(300).setZero();
    matrices[2].col(300).setZero();
    for (int repeat = 0; repeat < 2; ++repeat) {
        const std::vector<Eigen::MatrixXd> found = inverses_of(inverses, matrices);
        for (size_t m = 0; m < sizes.size(); ++m) {
            Eigen::MatrixXd A = matrices[m];
            if (m == 2)
                for (const int k : {300, 400, 499}) {
                    A.row(k).setZero();
                    A.col(k).setZero();
                    A(k, k) = 1.0;
                }
            Eigen::MatrixXd expected = A.inverse();
            if (m == 2)
                expected(300, 300) = expected(400, 400) = expected(499, 499) = 0.0;
            const Eigen::VectorXd scale = A.diagonal().cwiseSqrt();
            const Eigen::MatrixXd error = scale.asDiagonal() * (found[m] - expected) * scale.asDiagonal();
            EXPECT_LT(error.cwiseAbs().maxCoeff(), 1e-3) << sizes[m] << " rows";
        }
    }
}

} // namespace toile::test
