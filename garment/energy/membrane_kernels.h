#pragma once

#include <cmath>

#include "core/backend/types.h"

namespace toile {

/// det(C + d I) at or below which a triangle counts as collapsed [-]; 4 at rest. Raising it freezes thin
/// triangles; lowering it lets rounding noise choose their direction.
constexpr double kCollapsed = 1e-24;

/// Isometry closest to the deformation gradient F.
///
///   R = argmin |F - R|^2  over  R^T R = I        [Bouaziz et al. 2014, eq. 9]
///
/// R is the polar factor F (F^T F)^(-1/2). The 2x2 root is closed form, so no SVD and no iteration.
/// A collapsed triangle has no closest isometry: it gets F itself, that is no force.
TOILE_HD inline Mat32 closest_isometry(const Mat32& F)
{
    // Square root of C = F^T F from its invariants: S = (C + d I) / r, with d = sqrt(det C).
    const double a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const double d = std::sqrt(std::fmax(a * c - b * b, 0.0));
    const double r = std::sqrt(a + c + 2.0 * d);

    // S^(-1) = r adj(C + d I) / det(C + d I).
    const double det = (a + d) * (c + d) - b * b;
    if (!(det > kCollapsed))
        return F;
    Mat32 R;
    R.col(0) = (r / det) * ((c + d) * F.col(0) - b * F.col(1));
    R.col(1) = (r / det) * ((a + d) * F.col(1) - b * F.col(0));
    return R;
}

/// Weights of the membrane's three terms for one fabric [N/m]; see Membrane.
struct MembraneWeights {
    double warp = 0.0;  ///< on (|F u| - 1)^2
    double weft = 0.0;  ///< on (|F v| - 1)^2
    double shear = 0.0; ///< on |F - R|^2
};

/// Local step of the membrane on triangle t: projections of the deformation gradient, the energy that is
/// left, and the forces on two of the corners (the third balances them).
struct ProjectMembrane {
    View<const Vec3> x;        ///< [vertices]  positions [m]
    View<const Triangle> tri;  ///< [triangles] vertex indices
    View<const Mat2> rest_inv; ///< [triangles] inverse rest edge matrix [1/m]
    View<const double> area;   ///< [triangles] rest area [m^2]
    MembraneWeights weights;
    View<Mat32> corner_gradient; ///< [triangles] out: dW/dx1, dW/dx2 [N]; dW/dx0 is minus their sum
    View<double> energy;         ///< [triangles] out: [J]

    TOILE_HD void operator()(int t) const
    {
        // Deformation gradient: rest edges to current edges. Its columns are the stretched warp and weft.
        const Vec3 x0 = x[tri[t][0]];
        Mat32 edges;
        edges.col(0) = x[tri[t][1]] - x0;
        edges.col(1) = x[tri[t][2]] - x0;
        const Mat32 F = edges * rest_inv[t];

        // Distance to the projections: unit yarns along the current ones, and the closest isometry.
        Mat32 yarn;
        for (int k = 0; k < 2; ++k) {
            const double length = F.col(k).norm();
            yarn.col(k) = length > 0.0 ? Vec3(F.col(k) * (1.0 - 1.0 / length)) : Vec3(Vec3::Zero());
        }
        const Mat32 shear = F - closest_isometry(F);

        energy[t] = 0.5 * area[t] *
                    (weights.warp * yarn.col(0).squaredNorm() + weights.weft * yarn.col(1).squaredNorm() +
                     weights.shear * shear.squaredNorm());
        Mat32 stress = weights.shear * shear;
        stress.col(0) += weights.warp * yarn.col(0);
        stress.col(1) += weights.weft * yarn.col(1);
        corner_gradient[t] = area[t] * stress * rest_inv[t].transpose();
    }
};

/// Sums the corner gradients of vertex v.
struct GatherCorners {
    View<const int> first;             ///< [vertices + 1]
    View<const int> corners;           ///< 3 * triangle + corner, ascending per vertex
    View<const Mat32> corner_gradient; ///< [triangles]
    View<Vec3> gradient;               ///< [vertices] added to [N]

    TOILE_HD void operator()(int v) const
    {
        Vec3 sum = Vec3::Zero();
        for (int k = first[v]; k < first[v + 1]; ++k) {
            const Mat32& g = corner_gradient[corners[k] / 3];
            const int corner = corners[k] % 3;
            if (corner == 0)
                sum -= g.col(0) + g.col(1);
            else
                sum += g.col(corner - 1);
        }
        gradient[v] += sum;
    }
};

} // namespace toile
