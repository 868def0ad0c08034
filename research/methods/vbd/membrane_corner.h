#pragma once

#include <Eigen/Geometry>

#include "garment/energy/membrane_curvature.h"

namespace toile::research {

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

    /// Solves the system for b by L D L^T; the matrix must be positive definite.
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

/// Gradient of the hat function of one corner of a triangle.
template <typename T>
struct HatGradient {
    T u, v; ///< [1/m] derivatives along warp and weft
};

/// Adds the two yarn terms of add_membrane_corner(): springs along the columns of F.
template <typename T>
TOILE_HD void add_yarns(const Mat32Of<T>& F, const HatGradient<T>& g, const T& area,
                        const garment::MembraneWeights& weights, Vec3Of<T>& gradient, Symmetric3<T>& hessian)
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
    const garment::IsometryDerivative<T> D = garment::isometry_derivative<T>(F, true);

    // Add the gradient and the bound w |g|^2 I; a collapsed triangle has only the bound.
    const T used = select(D.is_valid, weight, T(0.0));
    const T square_of_g = g.u * g.u + g.v * g.v;
    gradient += used * (g.u * (F.col(0) - D.R0) + g.v * (F.col(1) - D.R1));
    hessian.add_identity(weight * square_of_g);

    // Subtract the modes of dR/dF: twist within the plane, then out of the plane.
    hessian.add_square(-used * D.twist, g.u * D.R1 - g.v * D.R0);
    const T through = g.u * g.u * D.S00 + T(2.0) * g.u * g.v * D.S01 + g.v * g.v * D.S11;
    hessian.add_square(-used * (D.alpha * square_of_g + D.beta * through), D.R0.cross(D.R1));
}

/// Adds the contribution of one membrane triangle to a corner: the gradient of its energy by the corner's
/// position, and the 3 x 3 block of its Hessian. The block is projected onto the positive semi-definite cone
/// mode by mode. With g the gradient of the corner's hat function, F = U diag(sigma) V^T, S = V diag(sigma)
/// V^T and n the normal, the unclamped block per area is
///
///   warp   w g_u^2 ( a a^T + (1 - 1/|F u|) (I - a a^T) ),   a = F u / |F u|;   weft likewise
///   shear  w ( |g|^2 I  -  (R J g)(R J g)^T / (sigma_1 + sigma_2)  -  (g^T S^(-1) g) n n^T )
///
/// where J rotates by 90 degrees (IsometryDerivative). The clamp limits each eigenvalue of dR/dF, and 1/|F u|
/// and 1/|F v|, to 1.
/// @param F         deformation gradient; its columns are the stretched warp and weft
/// @param area      rest area [m^2]
/// @param gradient  += [N]
/// @param hessian   += [N/m]
template <typename T>
TOILE_HD void add_membrane_corner(const Mat32Of<T>& F, const HatGradient<T>& g, const T& area,
                                  const garment::MembraneWeights& weights, Vec3Of<T>& gradient,
                                  Symmetric3<T>& hessian)
{
    add_yarns<T>(F, g, area, weights, gradient, hessian);
    add_shear<T>(F, g, T(weights.shear) * area, gradient, hessian);
}

/// Adds the contribution to corner 0 of a triangle; see add_membrane_corner().
/// @param edge1, edge2  edges from corner 0 to corners 1 and 2 [m]
/// @param rest_inv      [1/m] rows: hat gradients of corners 1 and 2
template <typename T>
TOILE_HD void add_first_corner(const Vec3Of<T>& edge1, const Vec3Of<T>& edge2, const Mat2Of<T>& rest_inv,
                               const T& area, const garment::MembraneWeights& weights, Vec3Of<T>& gradient,
                               Symmetric3<T>& hessian)
{
    Mat32Of<T> F;
    F.col(0) = rest_inv(0, 0) * edge1 + rest_inv(1, 0) * edge2;
    F.col(1) = rest_inv(0, 1) * edge1 + rest_inv(1, 1) * edge2;
    const HatGradient<T> g{-rest_inv(0, 0) - rest_inv(1, 0), -rest_inv(0, 1) - rest_inv(1, 1)};
    add_membrane_corner<T>(F, g, area, weights, gradient, hessian);
}

} // namespace toile::research
