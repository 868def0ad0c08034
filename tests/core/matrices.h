#pragma once

#include <random>
#include <vector>

#include <Eigen/Dense>

#include "core/linear/sparse_matrix.h"

/// Matrices and fields with a fixed seed that the tests of the linear solvers share.
namespace toile::test {

inline Eigen::MatrixX3d as_matrix(const std::vector<Vec3>& field)
{
    Eigen::MatrixX3d matrix(field.size(), 3);
    for (size_t i = 0; i < field.size(); ++i)
        matrix.row(int(i)) = field[i];
    return matrix;
}

inline std::vector<Vec3> as_field(const Eigen::MatrixX3d& matrix)
{
    std::vector<Vec3> field(matrix.rows());
    for (int i = 0; i < matrix.rows(); ++i)
        field[i] = matrix.row(i);
    return field;
}

inline std::vector<Vec3> random_field(int n, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    std::vector<Vec3> field(n);
    for (Vec3& v : field)
        v = Vec3(value(random), value(random), value(random));
    return field;
}

/// Random pattern with about six entries a row, random signs, eigenvalues at least 0.1.
inline SparseMatrix random_spd(int n, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    Triplets entries;
    for (int i = 0; i < n; ++i) {
        entries.emplace_back(i, i, 0.1);
        for (int k = 0; k < 3; ++k) {
            // Adds a (e_i + b e_j) (e_i + b e_j)^T with a > 0.
            const int j = int(random() % unsigned(n));
            const double a = 1.0 + value(random), b = value(random);
            entries.emplace_back(i, i, a);
            entries.emplace_back(j, j, a * b * b);
            entries.emplace_back(i, j, a * b);
            entries.emplace_back(j, i, a * b);
        }
    }
    SparseMatrix A(n, n);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

/// Five-point Laplacian of a grid plus `shift` times the identity.
inline SparseMatrix grid_laplacian(int columns, int rows, double shift)
{
    Triplets entries;
    const auto connect = [&](int a, int b) {
        entries.emplace_back(a, a, 1.0);
        entries.emplace_back(b, b, 1.0);
        entries.emplace_back(a, b, -1.0);
        entries.emplace_back(b, a, -1.0);
    };
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const int a = r * columns + c;
            entries.emplace_back(a, a, shift);
            if (c + 1 < columns)
                connect(a, a + 1);
            if (r + 1 < rows)
                connect(a, a + columns);
        }
    SparseMatrix A(columns * rows, columns * rows);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

/// Makes row and column `index` the identity's, keeping the pattern.
inline void isolate(SparseMatrix& A, int index)
{
    for (int row = 0; row < A.outerSize(); ++row)
        for (SparseMatrix::InnerIterator entry(A, row); entry; ++entry)
            if (entry.row() == index || entry.col() == index)
                entry.valueRef() = entry.row() == entry.col() ? 1.0 : 0.0;
}

} // namespace toile::test
