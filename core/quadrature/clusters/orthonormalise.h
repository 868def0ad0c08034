#pragma once

namespace toile {

/// Modified Gram-Schmidt. Columns that depend on others become zero: those of which less than 1e-6 is left.
template <typename Matrix>
void orthonormalise(Matrix& columns)
{
    constexpr double kDependent = 1e-6;
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
