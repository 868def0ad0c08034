#pragma once

#include <random>
#include <vector>

#include <Eigen/Dense>

#include "core/linear/sparse_matrix.h"

/// Matrices and fields with fixed seeds, shared by the tests of the linear solvers.
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

/// Adds a spring of stiffness 1 between two nodes.
inline void connect(int a, int b, Triplets& entries)
{
    entries.emplace_back(a, a, 1.0);
    entries.emplace_back(b, b, 1.0);
    entries.emplace_back(a, b, -1.0);
    entries.emplace_back(b, a, -1.0);
}

/// Five-point Laplacian of a grid plus `shift` times the identity.
inline SparseMatrix grid_laplacian(int columns, int rows, double shift)
{
    Triplets entries;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const int a = r * columns + c;
            entries.emplace_back(a, a, shift);
            if (c + 1 < columns)
                connect(a, a + 1, entries);
            if (r + 1 < rows)
                connect(a, a + columns, entries);
        }
    SparseMatrix A(columns * rows, columns * rows);
    A.setFromTriplets(entries.begin(), entries.end());
    return A;
}

/// Model of H of an irregular sheet that stretches with unit stiffness: cotangent weights on a grid of unit
/// cells, perturbed by a quarter and split along random diagonals. Masses are so small that stretch waves
/// travel `reach` cells in a time step.
inline SparseMatrix cloth_matrix(int columns, int rows, double reach, unsigned seed = 1)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shake(-0.25, 0.25);
    std::vector<Vec3> x(size_t(columns) * rows);
    for (int i = 0; i < int(x.size()); ++i) {
        const int column = i % columns, row = i / columns;
        const double dx = shake(random), dy = shake(random);
        x[i] = Vec3(column + dx, row + dy, 0.0);
    }
    Triplets entries;
    const auto add_triangle = [&](int a, int b, int c) {
        const double twice_area = (x[b] - x[a]).cross(x[c] - x[a]).norm();
        for (int k = 0; k < 3; ++k, std::swap(a, b), std::swap(b, c)) { // rotates a, b, c
            const double w = 0.5 * (x[a] - x[c]).dot(x[b] - x[c]) / twice_area;
            entries.emplace_back(a, a, w);
            entries.emplace_back(b, b, w);
            entries.emplace_back(a, b, -w);
            entries.emplace_back(b, a, -w);
            entries.emplace_back(c, c, twice_area / (6.0 * reach * reach));
        }
    };
    for (int row = 0; row + 1 < rows; ++row)
        for (int column = 0; column + 1 < columns; ++column) {
            const int a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
            const bool rising = random() % 2 == 0;
            add_triangle(a, b, rising ? d : c);
            rising ? add_triangle(a, d, c) : add_triangle(b, d, c);
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
