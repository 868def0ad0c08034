#pragma once

#include <Eigen/Geometry>

#include "garment/energy/membrane_kernels.h"

namespace toile::garment {

/// Relative difference below which two principal stretches count as equal [-]: their eigenvectors are then
/// rounding noise.
constexpr double kSameStretch = 1e-9;

/// Derivative of the closest isometry R of a deformation gradient F = U diag(sigma) V^T with respect to F. It
/// has three non-zero eigenvalues [Smith et al. 2019 give them for 3 x 3]:
///
///   twist              2 / (sigma_1 + sigma_2), along the mode (R J) / sqrt(2), J the rotation by 90 degrees
///   out of the plane   1 / sigma_1, 1 / sigma_2: S^(-1) with S = V diag(sigma) V^T
template <typename T>
struct IsometryDerivative {
    Vec3Of<T> R0, R1;             ///< columns of R
    T S00, S01, S11;              ///< S^(-1)
    T twist;                      ///< half the eigenvalue above
    T alpha, beta;                ///< out of the plane: alpha I + beta S^(-1)
    decltype(T() < T()) is_valid; ///< false: collapsed, the other members are meaningless
};

/// @param is_projected  cuts every eigenvalue at 1, which makes I - dR/dF positive semi-definite
template <typename T>
TOILE_HD IsometryDerivative<T> isometry_derivative(const Mat32Of<T>& F, bool is_projected)
{
    // Invariants of C = F^T F: d = sigma_1 sigma_2, r = sigma_1 + sigma_2. S^(-1) = adj(C + d I) / (d r).
    const T zero(0.0), one(1.0);
    const T a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const T square = a * c - b * b;
    const T d = square_root(select(square > zero, square, zero));
    const T r = square_root(a + c + T(2.0) * d);
    IsometryDerivative<T> D;
    D.is_valid = d * r * r > T(kCollapsed);
    const T scale = one / select(D.is_valid, d * r, one);
    D.S00 = scale * (c + d);
    D.S01 = -scale * b;
    D.S11 = scale * (a + d);
    D.R0 = D.S00 * F.col(0) + D.S01 * F.col(1);
    D.R1 = D.S01 * F.col(0) + D.S11 * F.col(1);
    if (!is_projected) {
        D.twist = one / select(D.is_valid, r, one);
        D.alpha = zero;
        D.beta = one;
        return D;
    }

    // min(I, S^(-1)) = alpha I + beta S^(-1), through the two eigenvalues 1 / sigma.
    D.twist = select(r > T(2.0), one / r, T(0.5));
    const T half = T(0.5) * r, discriminant = half * half - d;
    const T spread = square_root(select(discriminant > zero, discriminant, zero));
    const T low = scale * r * (half - spread), high = scale * r * (half + spread);
    const T low_cut = select(low < one, low, one), high_cut = select(high < one, high, one);
    const auto is_split = high - low > T(kSameStretch) * high;
    D.beta = select(is_split, (high_cut - low_cut) / select(is_split, high - low, one),
                    select(high < one, one, zero));
    D.alpha = low_cut - D.beta * low;
    return D;
}

/// Second derivative of the membrane's energy per area by F: blocks for the columns u and v [N/m].
template <typename T>
struct MembraneCurvature {
    Mat3Of<T> uu, uv, vv;
};

/// Second derivative of the membrane's energy per area. With a = F u / |F u| and n the normal, per term:
///
///   warp   w ( a a^T + (1 - 1/|F u|) (I - a a^T) );   weft likewise
///   shear  w ( I - dR/dF )
template <typename T>
TOILE_HD MembraneCurvature<T> membrane_curvature(const Mat32Of<T>& F, const MembraneWeights& weights,
                                                 bool is_projected)
{
    const T zero(0.0), one(1.0);
    const IsometryDerivative<T> D = isometry_derivative<T>(F, is_projected);
    const T w = select(D.is_valid, T(weights.shear), zero);
    const Vec3Of<T> n = D.R0.cross(D.R1);
    MembraneCurvature<T> H;
    H.uu =
        (-w * D.twist) * (D.R1 * D.R1.transpose()) - (w * (D.alpha + D.beta * D.S00)) * (n * n.transpose());
    H.uv = (w * D.twist) * (D.R1 * D.R0.transpose()) - (w * D.beta * D.S01) * (n * n.transpose());
    H.vv =
        (-w * D.twist) * (D.R0 * D.R0.transpose()) - (w * (D.alpha + D.beta * D.S11)) * (n * n.transpose());

    // Add the identity of the shear term; a collapsed triangle has nothing else.
    Mat3Of<T>* diagonal[2] = {&H.uu, &H.vv};
    const double yarn[2] = {weights.warp, weights.weft};
    for (int k = 0; k < 2; ++k) {
        const T length = square_root(F.col(k).squaredNorm());
        const T inverse = one / select(length > zero, length, one);
        const Vec3Of<T> along = inverse * F.col(k);
        T tension = one - inverse;
        if (is_projected)
            tension = select(tension > zero, tension, zero);
        *diagonal[k] += (T(yarn[k]) * (one - tension)) * (along * along.transpose());
        const T identity = T(weights.shear) + T(yarn[k]) * tension;
        for (int i = 0; i < 3; ++i)
            (*diagonal[k])(i, i) += identity;
    }
    return H;
}

} // namespace toile::garment
