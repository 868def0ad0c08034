#pragma once

#include <cmath>

#include "core/backend/types.h"

namespace toile {

/// Singular values and right singular vectors of a deformation gradient F [3 x 2], closed form.
struct PrincipalStretch {
    Vec2 sigma; ///< [-] largest first
    Mat2 V;     ///< columns: directions in material axes
};

TOILE_HD inline PrincipalStretch principal_stretch(const Mat32& F)
{
    // Eigenvectors of C = F^T F from its deviator (half, b).
    const double a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const double mean = 0.5 * (a + c), half = 0.5 * (a - c);
    const double radius = std::hypot(half, b);
    PrincipalStretch result;
    result.sigma = Vec2(std::sqrt(mean + radius), std::sqrt(std::fmax(mean - radius, 0.0)));
    const double angle = radius > 0.0 ? 0.5 * std::atan2(b, half) : 0.0;
    const double cosine = std::cos(angle), sine = std::sin(angle);
    result.V << cosine, -sine, sine, cosine;
    return result;
}

/// Largest singular value of F alone, without trigonometry.
TOILE_HD inline double largest_stretch(const Mat32& F)
{
    const double a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const double half = 0.5 * (a - c);
    return std::sqrt(0.5 * (a + c) + std::sqrt(half * half + b * b));
}

} // namespace toile
