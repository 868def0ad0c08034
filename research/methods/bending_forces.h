#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/linear/sparse_matrix.h"

namespace toile::research {

/// Maximum of h^2 times the largest eigenvalue of K / m for which bending acts by explicit forces [-].
/// Symplectic Euler is stable up to 4; at 1 the frequency of the fastest mode is 5 % off.
constexpr double kExplicitBending = 1.0;

/// Bound on the eigenvalues of K / m by Gershgorin's circles [1/s^2].
/// @param K       Bending::matrix()
/// @param masses  [vertices] [kg]
inline double fastest_bending(const SparseMatrix& K, const std::vector<double>& masses)
{
    double largest = 0.0;
    for (int row = 0; row < K.outerSize(); ++row) {
        double sum = 0.0;
        for (SparseMatrix::InnerIterator entry(K, row); entry; ++entry)
            sum += std::abs(entry.value());
        largest = std::max(largest, sum / masses[row]);
    }
    return largest;
}

/// True if bending may act by its forces at the start of a substep of h [s].
/// @param fastest  from fastest_bending()
inline bool allows_bending_forces(double fastest, double h)
{
    return fastest > 0.0 && h * h * fastest < kExplicitBending;
}

} // namespace toile::research
