#pragma once

#include "garment/energy/membrane_kernels.h"

namespace toile::research {

/// Factors h^2 w A of the membrane's terms on one triangle [J s^2]: the inverse of XPBD's time-step scaled
/// compliance alpha / h^2, finite even if a term is absent.
template <typename T>
struct StrainStiffness {
    T warp, weft, shear;
};

/// Unit vector in material axes of the largest stretch of F; (1, 0) if all stretches are equal.
template <typename T>
TOILE_HD Eigen::Matrix<T, 2, 1> principal_direction(const Mat32Of<T>& F)
{
    // Compute the eigenvector of the deviator (half, b) of F^T F, from its row without cancellation.
    const T a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const T half = T(0.5) * (a - c);
    const T radius = square_root(half * half + b * b);
    const auto is_warp = half > T(0.0);
    const T u = select(is_warp, radius + half, b), v = select(is_warp, b, radius - half);
    const T length2 = u * u + v * v;
    const auto is_split = length2 > T(0.0);
    const T inverse = T(1.0) / square_root(select(is_split, length2, T(1.0)));
    Eigen::Matrix<T, 2, 1> direction;
    direction(0) = select(is_split, u * inverse, T(1.0));
    direction(1) = select(is_split, v * inverse, T(0.0));
    return direction;
}

/// Projects C = |F p| - 1 in a material direction p; adds its multiplier to D and its effect to F.
///
///   d lambda = -C / (p^T N p + alpha / h^2)                           [Macklin et al. 2016, eq. 18]
///   dC/dx_k = q (p . g_k),   q = F p / |F p|
template <typename T>
TOILE_HD void project_stretch(const Eigen::Matrix<T, 2, 1>& p, const T& stiffness, const Mat2Of<T>& N,
                              Mat32Of<T>& F, Mat32Of<T>& D)
{
    // Scale q to d lambda F p / |F p|, with one division.
    Vec3Of<T> q = p(0) * F.col(0) + p(1) * F.col(1);
    const T length = square_root(q.squaredNorm());
    const T n0 = N(0, 0) * p(0) + N(0, 1) * p(1), n1 = N(1, 0) * p(0) + N(1, 1) * p(1);
    const T divisor = (stiffness * (p(0) * n0 + p(1) * n1) + T(1.0)) * length;
    q *= stiffness * (T(1.0) - length) / select(length > T(0.0), divisor, T(1.0));
    D.col(0) += p(0) * q;
    D.col(1) += p(1) * q;
    F.col(0) += n0 * q;
    F.col(1) += n1 * q;
}

/// Makes one Gauss-Seidel pass over the constraints of a triangle, whose energies 1/2 C^2 / alpha are those
/// of Membrane. |F u| - 1 has compliance 1 / (A w_warp), |F v| - 1 has 1 / (A w_weft). Both principal
/// stretches sigma - 1 have 1 / (A w_shear), because |F - R|^2 = (sigma_1 - 1)^2 + (sigma_2 - 1)^2.
/// @param F  deformation gradient
/// @param N  sum over corners of g_k g_k^T / m_k [1/(kg m^2)], g_k the hat gradients
/// @return D [3 x 2]: corner k moves by D g_k / m_k
template <typename T>
TOILE_HD Mat32Of<T> project_strains(Mat32Of<T> F, const Mat2Of<T>& N, const StrainStiffness<T>& stiffness)
{
    using Direction = Eigen::Matrix<T, 2, 1>;
    Mat32Of<T> D;
    for (int k = 0; k < 6; ++k)
        D(k) = T(0.0);
    project_stretch<T>(Direction(T(1.0), T(0.0)), stiffness.warp, N, F, D);
    project_stretch<T>(Direction(T(0.0), T(1.0)), stiffness.weft, N, F, D);

    // The images of the principal directions are perpendicular, so their projections do not interfere.
    const Direction p = principal_direction<T>(F);
    project_stretch<T>(p, stiffness.shear, N, F, D);
    project_stretch<T>(Direction(-p(1), p(0)), stiffness.shear, N, F, D);
    return D;
}

/// Inputs of the constraints of a triangle.
template <typename T>
struct StrainTriangle {
    Vec3Of<T> edge1, edge2; ///< edges from corner 0 to corners 1 and 2 [m]
    T mobility[3];          ///< [1/kg] of the corners, 0 if fixed
    Mat2Of<T> rest_inv;     ///< [1/m] rows: hat gradients of corners 1 and 2
    T area;                 ///< [m^2]
};

/// Makes one pass over the constraints of a triangle in a substep of h [s].
/// @return column k: displacement of corner k [m]
template <typename T>
TOILE_HD Mat3Of<T> strain_moves(const StrainTriangle<T>& triangle, const garment::MembraneWeights& weights,
                                double h)
{
    // Compute the deformation gradient, and N from the hat gradients of the three corners.
    const Mat2Of<T>& inv = triangle.rest_inv;
    const T hat_u[3] = {-inv(0, 0) - inv(1, 0), inv(0, 0), inv(1, 0)};
    const T hat_v[3] = {-inv(0, 1) - inv(1, 1), inv(0, 1), inv(1, 1)};
    Mat2Of<T> N;
    N(0, 0) = N(0, 1) = N(1, 1) = T(0.0);
    for (int k = 0; k < 3; ++k) {
        N(0, 0) += triangle.mobility[k] * hat_u[k] * hat_u[k];
        N(0, 1) += triangle.mobility[k] * hat_u[k] * hat_v[k];
        N(1, 1) += triangle.mobility[k] * hat_v[k] * hat_v[k];
    }
    N(1, 0) = N(0, 1);
    Mat32Of<T> F;
    F.col(0) = inv(0, 0) * triangle.edge1 + inv(1, 0) * triangle.edge2;
    F.col(1) = inv(0, 1) * triangle.edge1 + inv(1, 1) * triangle.edge2;

    const T scale = triangle.area * T(h * h);
    const StrainStiffness<T> stiffness{scale * T(weights.warp), scale * T(weights.weft),
                                       scale * T(weights.shear)};
    const Mat32Of<T> D = project_strains<T>(F, N, stiffness);
    Mat3Of<T> moves;
    for (int k = 0; k < 3; ++k)
        moves.col(k) =
            (triangle.mobility[k] * hat_u[k]) * D.col(0) + (triangle.mobility[k] * hat_v[k]) * D.col(1);
    return moves;
}

} // namespace toile::research
