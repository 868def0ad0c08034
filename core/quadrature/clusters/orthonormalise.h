#pragma once

namespace toile {

/// Relative length [-] below which a column after orthogonalisation is rounding error: fewer nodes than
/// functions, or nodes on a line or in a plane.
inline constexpr double kDependent = 1e-6;

/// Modified Gram-Schmidt; dependent columns become zero. The second pass takes what rounding left.
template <typename Matrix>
void orthonormalise(Matrix& columns)
{
    for (int k = 0; k < columns.cols(); ++k) {
        const double length = columns.col(k).norm();
        for (int pass = 0; pass < 2; ++pass)
            for (int j = 0; j < k; ++j)
                columns.col(k) -= columns.col(j).dot(columns.col(k)) * columns.col(j);
        const double rest = columns.col(k).norm();
        if (rest > kDependent * length)
            columns.col(k) /= rest;
        else
            columns.col(k).setZero();
    }
}

} // namespace toile
