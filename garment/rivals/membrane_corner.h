#pragma once

#include <Eigen/Geometry>

#include "garment/energy/membrane_kernels.h"
#include "garment/rivals/lane_gather.h"

namespace toile {

/// Relative difference of two principal stretches below which they count as one [-]: their eigenvectors are
/// then rounding noise.
constexpr double kSameStretch = 1e-9;

/// Symmetric 3 x 3 matrix, for one vertex (T = double) or eight (T = Lanes).
template <typename T>
struct Symmetric3 {
    T xx, yy, zz, xy, xz, yz;

    TOILE_HD explicit Symmetric3(const T& diagonal)
        : xx(diagonal), yy(diagonal), zz(diagonal), xy(0.0), xz(0.0), yz(0.0)
    {
    }

    /// += c I
    TOILE_HD void add_identity(const T& c)
    {
        xx += c;
        yy += c;
        zz += c;
    }

    /// += c a a^T
    TOILE_HD void add_square(const T& c, const Vec3Of<T>& a)
    {
        const T x = c * a(0), y = c * a(1), z = c * a(2);
        xx += x * a(0);
        yy += y * a(1);
        zz += z * a(2);
        xy += x * a(1);
        xz += x * a(2);
        yz += y * a(2);
    }

    /// The inverse times b by L D L^T; the matrix must be positive definite.
    TOILE_HD Vec3Of<T> solve(const Vec3Of<T>& b) const
    {
        const T inverse_x = T(1.0) / xx;
        const T lyx = xy * inverse_x, lzx = xz * inverse_x;
        const T inverse_y = T(1.0) / (yy - lyx * xy);
        const T rest = yz - lzx * xy, lzy = rest * inverse_y;
        const T dz = zz - lzx * xz - lzy * rest;
        const T y = b(1) - lyx * b(0);
        Vec3Of<T> result;
        result(2) = (b(2) - lzx * b(0) - lzy * y) / dz;
        result(1) = y * inverse_y - lzy * result(2);
        result(0) = b(0) * inverse_x - lyx * result(1) - lzx * result(2);
        return result;
    }
};

/// The corner of a triangle that a response is for, by its hat function.
template <typename T>
struct HatGradient {
    T u, v; ///< [1/m] derivatives along warp and weft
};

/// Adds the two yarn terms of add_membrane_corner(): springs along the columns of F.
template <typename T>
TOILE_HD void add_yarns(const Mat32Of<T>& F, const HatGradient<T>& g, const T& area,
                        const MembraneWeights& weights, Vec3Of<T>& gradient, Symmetric3<T>& hessian)
{
    const T zero(0.0), one(1.0);
    const T hat[2] = {g.u, g.v};
    const double yarn[2] = {weights.warp, weights.weft};
    for (int k = 0; k < 2; ++k) {
        const T length = square_root(F.col(k).squaredNorm());
        const T inverse = one / select(length > zero, length, one);
        const Vec3Of<T> along = inverse * F.col(k);
        const T weight = T(yarn[k]) * area * hat[k];
        const T tension = select(length > one, one - inverse, zero);
        gradient += (weight * (length - one)) * along;
        hessian.add_identity(weight * hat[k] * tension);
        hessian.add_square(weight * hat[k] * (one - tension), along);
    }
}

/// Adds the shear term of add_membrane_corner(): the distance to the closest isometry R.
template <typename T>
TOILE_HD void add_shear(const Mat32Of<T>& F, const HatGradient<T>& g, const T& weight, Vec3Of<T>& gradient,
                        Symmetric3<T>& hessian)
{
    // Invariants of C = F^T F: d = sigma_1 sigma_2, r = sigma_1 + sigma_2. S^(-1) = adj(C + d I) / (d r).
    const T zero(0.0), one(1.0);
    const T a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const T square = a * c - b * b;
    const T d = square_root(select(square > zero, square, zero));
    const T r = square_root(a + c + T(2.0) * d);
    const auto is_valid = d * r * r > T(kCollapsed);
    const T scale = one / select(is_valid, d * r, one);
    const T S00 = scale * (c + d), S01 = -scale * b, S11 = scale * (a + d);
    const Vec3Of<T> R0 = S00 * F.col(0) + S01 * F.col(1), R1 = S01 * F.col(0) + S11 * F.col(1);

    // The gradient, and the bound w |g|^2 I that is all a collapsed triangle has.
    const T used = select(is_valid, weight, zero);
    const T square_of_g = g.u * g.u + g.v * g.v;
    gradient += used * (g.u * (F.col(0) - R0) + g.v * (F.col(1) - R1));
    hessian.add_identity(weight * square_of_g);

    // Twist within the plane: 2 / r, at most 1.
    const T twist = select(r > T(2.0), one / r, T(0.5));
    hessian.add_square(-used * twist, g.u * R1 - g.v * R0);

    // Out of the plane: min(I, S^(-1)) = alpha I + beta S^(-1), through the two eigenvalues 1 / sigma.
    const T half = T(0.5) * r, discriminant = half * half - d;
    const T spread = square_root(select(discriminant > zero, discriminant, zero));
    const T low = scale * r * (half - spread), high = scale * r * (half + spread);
    const T low_cut = select(low < one, low, one), high_cut = select(high < one, high, one);
    const auto is_split = high - low > T(kSameStretch) * high;
    const T beta = select(is_split, (high_cut - low_cut) / select(is_split, high - low, one),
                          select(high < one, one, zero));
    const T alpha = low_cut - beta * low;
    const T through = g.u * g.u * S00 + T(2.0) * g.u * g.v * S01 + g.v * g.v * S11;
    hessian.add_square(-used * (alpha * square_of_g + beta * through), R0.cross(R1));
}

/// Adds what one triangle of the membrane contributes to a corner: the gradient of its energy by the corner's
/// position and the 3 x 3 block of its Hessian, projected onto the positive semi-definite cone mode by mode.
/// With g the gradient of the corner's hat function, F = U diag(sigma) V^T, S = V diag(sigma) V^T and n the
/// normal, the unclamped block per area is
///
///   warp   w g_u^2 ( a a^T + (1 - 1/|F u|) (I - a a^T) ),   a = F u / |F u|;   weft likewise
///   shear  w ( |g|^2 I  -  (R J g)(R J g)^T / (sigma_1 + sigma_2)  -  (g^T S^(-1) g) n n^T )
///
/// where J turns by 90 degrees. 2/(sigma_1 + sigma_2), 1/sigma_1 and 1/sigma_2 are the eigenvalues of dR/dF
/// for the twist and the two modes out of the plane [Smith et al. 2019 have them for 3 x 3]. The clamp cuts
/// each of them, and 1/|F u| and 1/|F v|, at 1.
/// @param F         deformation gradient; its columns are the stretched warp and weft
/// @param area      rest area [m^2]
/// @param gradient  += [N]
/// @param hessian   += [N/m]
template <typename T>
TOILE_HD void add_membrane_corner(const Mat32Of<T>& F, const HatGradient<T>& g, const T& area,
                                  const MembraneWeights& weights, Vec3Of<T>& gradient, Symmetric3<T>& hessian)
{
    add_yarns<T>(F, g, area, weights, gradient, hessian);
    add_shear<T>(F, g, T(weights.shear) * area, gradient, hessian);
}

} // namespace toile
