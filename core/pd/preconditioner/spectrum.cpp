#include "core/pd/preconditioner/spectrum.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <Eigen/Eigenvalues>

#include "core/base/error.h"

namespace toile {

namespace {

/// Fraction of noise in the start vector, beside the constant field; it finds the upper end.
constexpr double kNoise = 0.3;

/// Relative length of a Lanczos vector below which the Krylov space is exhausted.
constexpr double kExhausted = 1e-12;

double gershgorin(const SparseMatrix& A, View<const double> inverse_diagonal)
{
    double highest = 0.0;
    for (int row = 0; row < int(A.rows()); ++row) {
        double sum = 0.0;
        for (SparseMatrix::InnerIterator entry(A, row); entry; ++entry)
            if (inverse_diagonal[int(entry.col())] > 0.0)
                sum += std::abs(entry.value());
        highest = std::max(highest, sum * inverse_diagonal[row]);
    }
    return highest;
}

/// Ritz values, ascending; none if every row is excluded.
Eigen::VectorXd lanczos(const SparseMatrix& A, View<const double> inverse_diagonal, int steps)
{
    const int n = int(A.rows());
    const Eigen::VectorXd scale =
        Eigen::Map<const Eigen::VectorXd>(inverse_diagonal.data(), n).array().sqrt().matrix();
    steps = std::min(steps, int((scale.array() > 0.0).count()));
    Eigen::MatrixXd basis(n, steps);
    Eigen::VectorXd diagonal(steps), off_diagonal(steps);

    // Start at D^1/2 (1 + noise), zero at excluded rows.
    std::mt19937 random(1);
    Eigen::VectorXd v(n);
    for (int i = 0; i < n; ++i) {
        const double noise = kNoise * (double(random()) / double(std::mt19937::max()) - 0.5);
        v[i] = scale[i] > 0.0 ? (1.0 + noise) / scale[i] : 0.0;
    }

    int count = 0;
    for (double length = v.norm(); count < steps && length > 0.0; ++count) {
        basis.col(count) = v / length;
        v = scale.cwiseProduct(A * scale.cwiseProduct(basis.col(count)));
        diagonal[count] = basis.col(count).dot(v);
        const double before = v.norm();
        for (int pass = 0; pass < 2; ++pass) { // two passes suffice
            const auto known = basis.leftCols(count + 1);
            const Eigen::VectorXd overlap = known.transpose() * v;
            v -= known * overlap;
        }
        length = v.norm();
        if (!(length > kExhausted * before))
            length = 0.0;
        off_diagonal[count] = length;
    }
    if (count == 0)
        return {};
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
    ritz.computeFromTridiagonal(diagonal.head(count), off_diagonal.head(count - 1), Eigen::EigenvaluesOnly);
    return ritz.eigenvalues();
}

} // namespace

SpectralBounds estimate_bounds(const SparseMatrix& A, View<const double> inverse_diagonal, int lanczos_steps)
{
    const Eigen::VectorXd ritz = lanczos(A, inverse_diagonal, lanczos_steps);
    if (ritz.size() == 0)
        return {};
    const double lowest = ritz[0], highest = ritz[ritz.size() - 1];
    if (!(lowest > 0.0) || !std::isfinite(highest))
        throw InvalidInput("matrix is not positive definite: D^-1 A has a Ritz value of " +
                           std::to_string(lowest) + ", positive ones are needed");
    return {std::min(1.0, kMinMargin * lowest),
            std::min(kMaxMargin * highest, gershgorin(A, inverse_diagonal))};
}

} // namespace toile
