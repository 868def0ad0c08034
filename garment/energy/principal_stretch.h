#pragma once

#include <cmath>

#include "core/compute/types.h"

namespace toile::garment {

/// Singular values and right singular vectors of a deformation gradient F [3 x 2], closed form.
struct PrincipalStretch {
    Vec2 sigma; ///< [-] largest first
    Mat2 V;     ///< columns: directions in material axes

    /// V diag(values) V^T
    TOILE_HD Mat2 with(double first, double second) const
    {
        const double c = V(0, 0), s = V(1, 0), across = (first - second) * c * s;
        Mat2 result;
        result(0, 0) = first * c * c + second * s * s;
        result(0, 1) = across;
        result(1, 0) = across;
        result(1, 1) = first * s * s + second * c * c;
        return result;
    }
};

TOILE_HD inline PrincipalStretch principal_stretch(const Mat32& F)
{
    // Compute the eigenvectors of C = F^T F from its deviator (half, b): they lie at half the deviator's
    // angle. The larger of sine and cosine comes first, since it has no cancellation.
    const double a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const double mean = 0.5 * (a + c), half = 0.5 * (a - c);
    const double radius = std::sqrt(half * half + b * b);
    PrincipalStretch result;
    result.sigma = Vec2(std::sqrt(mean + radius), std::sqrt(std::fmax(mean - radius, 0.0)));
    double cosine = 1.0, sine = 0.0;
    if (radius > 0.0) {
        const double larger = std::sqrt(0.5 + 0.5 * std::fabs(half) / radius);
        const double smaller = 0.5 * b / (radius * larger);
        cosine = half > 0.0 ? larger : smaller;
        sine = half > 0.0 ? smaller : larger;
    }
    result.V(0, 0) = cosine;
    result.V(0, 1) = -sine;
    result.V(1, 0) = sine;
    result.V(1, 1) = cosine;
    return result;
}

/// Largest singular value of F, without the singular vectors.
TOILE_HD inline double largest_stretch(const Mat32& F)
{
    const double a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const double half = 0.5 * (a - c);
    return std::sqrt(0.5 * (a + c) + std::sqrt(half * half + b * b));
}

} // namespace toile::garment
