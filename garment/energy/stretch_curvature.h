#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>

#include "core/linear/block_matrix.h"
#include "garment/energy/principal_stretch.h"

namespace toile::garment {

/// Second derivative of an energy per area of a triangle by its deformation gradient F: 3 x 3 blocks for the
/// columns u and v of F; vu is the transpose of uv. [N/m]
struct StretchCurvature {
    Mat3 uu = Mat3::Zero(), uv = Mat3::Zero(), vv = Mat3::Zero();

    /// += weight vec(E) vec(E)^T
    TOILE_HD void add_mode(double weight, const Mat32& E)
    {
        const Vec3 u = weight * E.col(0), v = weight * E.col(1);
        uu += u.lazyProduct(E.col(0).transpose());
        uv += u.lazyProduct(E.col(1).transpose());
        vv += v.lazyProduct(E.col(1).transpose());
    }
};

/// Blocks between one corner of a triangle and its corners.
struct CornerBlocks {
    Vec2 g[3]; ///< gradients of the corners' hat functions [1/m]
    Mat3 u, v; ///< derivatives of the corner's gradient by the columns of F [N]

    /// @tparam Curvature  StretchCurvature or MembraneCurvature<double>
    /// @param rest_inv    inverse rest edge matrix [1/m]
    /// @param area        rest area [m^2]
    template <typename Curvature>
    TOILE_HD CornerBlocks(const Curvature& H, const Mat2& rest_inv, double area, int corner)
    {
        g[1] = rest_inv.row(0);
        g[2] = rest_inv.row(1);
        g[0] = -g[1] - g[2];
        u = area * (g[corner][0] * H.uu + g[corner][1] * H.uv.transpose());
        v = area * (g[corner][0] * H.uv + g[corner][1] * H.vv);
    }
    TOILE_HD Mat3 with(int other) const { return g[other][0] * u + g[other][1] * v; }
};

/// Positions of the blocks between one corner of a triangle and its three corners in that corner's row.
using CornerPositions = std::array<int, 3>;

/// @return [3 * triangles] by 3 * triangle + corner
inline std::vector<CornerPositions> corner_positions(View<const Triangle> triangles, BlockWindow K)
{
    std::vector<CornerPositions> positions;
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            positions.push_back({K.position(t[k], t[0]), K.position(t[k], t[1]), K.position(t[k], t[2])});
    return positions;
}

/// Adds the blocks between a corner of a triangle and its three corners.
/// @param rest_inv  inverse rest edge matrix [1/m]
/// @param area      rest area [m^2]
/// @param row       blocks of the corner's row
inline void add_corner_row(const StretchCurvature& H, const Mat2& rest_inv, double area, int corner,
                           const CornerPositions& position, Mat3* row)
{
    const CornerBlocks blocks(H, rest_inv, area, corner);
    for (int k = 0; k < 3; ++k)
        row[position[k]] += blocks.with(k);
}

/// Adds the pairs of corners of every triangle.
inline void add_triangle_couplings(View<const Triangle> triangles,
                                   std::vector<std::pair<int, int>>& couplings)
{
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            couplings.emplace_back(t[k], t[(k + 1) % 3]);
}

/// Second derivative of 1/2 |G - P(G)|^2, P the projection onto the matrices with singular values up to
/// `allowed`. Let f(s) = max(s - allowed, 0) of the singular values s_1 >= s_2. The eigenvalues are at least
/// zero because the set is convex:
///
///   stretches          f'(s_1), f'(s_2)
///   twist, flip        (f_1 + f_2) / (s_1 + s_2),  (f_1 - f_2) / (s_1 - s_2)
///   out of the plane   f_1 / s_1, f_2 / s_2
///
/// after [Smith et al. 2019], whose 3 x 3 case has three of each. Zero if s_1 <= allowed.
TOILE_HD inline StretchCurvature excess_curvature(const Mat32& G, double allowed)
{
    StretchCurvature H;
    const PrincipalStretch stretch = principal_stretch(G);
    const double s1 = stretch.sigma[0], s2 = stretch.sigma[1];
    if (!(s1 > allowed))
        return H;
    const double f1 = s1 - allowed, f2 = std::fmax(s2 - allowed, 0.0);

    // Left singular vectors; the second is free where G has collapsed to a line.
    const Vec2 v1 = stretch.V.col(0), v2 = stretch.V.col(1);
    const Vec3 u1 = (G * v1).normalized();
    const Vec3 along = G * v2;
    Vec3 u2 = along - u1 * u1.dot(along);
    u2 = u2.norm() > 1e-12 * s1 ? u2.normalized() : u1.unitOrthogonal();
    const Vec3 n = u1.cross(u2);

    const Mat32 across = u1.lazyProduct(v2.transpose()), back = u2.lazyProduct(v1.transpose());
    const double flip = s1 - s2 > 1e-9 * s1 ? (f1 - f2) / (s1 - s2) : 1.0;
    H.add_mode(1.0, u1.lazyProduct(v1.transpose()));
    H.add_mode(s2 > allowed ? 1.0 : 0.0, u2.lazyProduct(v2.transpose()));
    H.add_mode(0.5 * (f1 + f2) / (s1 + s2), across - back);
    H.add_mode(0.5 * flip, across + back);
    H.add_mode(f1 / s1, n.lazyProduct(v1.transpose()));
    H.add_mode(f2 / std::fmax(s2, allowed), n.lazyProduct(v2.transpose()));
    return H;
}

} // namespace toile::garment
