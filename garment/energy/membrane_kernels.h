#pragma once

#include <cmath>

#include "core/compute/lanes.h"

namespace toile::garment {

/// Largest det(C + d I) of a collapsed triangle [-]; 4 in the rest shape. A larger value freezes thin
/// triangles; a smaller one lets rounding noise choose their direction.
constexpr double kCollapsed = 1e-24;

/// Isometry closest to the deformation gradient F.
///
///   R = argmin |F - R|^2  over  R^T R = I        [Bouaziz et al. 2014, eq. 9]
///
/// R is the polar factor F (F^T F)^(-1/2). The 2x2 root is closed form, so no SVD and no iteration.
/// A collapsed triangle has no closest isometry: it gets F itself, that is no force.
template <typename T>
TOILE_HD Mat32Of<T> closest_isometry(const Mat32Of<T>& F)
{
    // Square root of C = F^T F from its invariants: S = (C + d I) / r, with d = sqrt(det C).
    const T a = F.col(0).squaredNorm(), b = F.col(0).dot(F.col(1)), c = F.col(1).squaredNorm();
    const T square = a * c - b * b;
    const T d = square_root(select(square > T(0.0), square, T(0.0)));
    const T r = square_root(a + c + T(2.0) * d);

    // S^(-1) = r adj(C + d I) / det(C + d I).
    const T det = (a + d) * (c + d) - b * b;
    const auto is_valid = det > T(kCollapsed);
    const T scale = r / select(is_valid, det, T(1.0));
    Mat32Of<T> R;
    R.col(0) = scale * ((c + d) * F.col(0) - b * F.col(1));
    R.col(1) = scale * ((a + d) * F.col(1) - b * F.col(0));
    for (int k = 0; k < 6; ++k)
        R(k) = select(is_valid, R(k), F(k));
    return R;
}

/// Weights of the membrane's three terms for one fabric [N/m]; see Membrane.
struct MembraneWeights {
    double warp = 0.0;  ///< on (|F u| - 1)^2
    double weft = 0.0;  ///< on (|F v| - 1)^2
    double shear = 0.0; ///< on |F - R|^2
};

/// Energy of a triangle [J] and the forces on two of its corners (the third balances them).
template <typename T>
struct MembraneResponse {
    Mat32Of<T> corner_gradient; ///< dW/dx1, dW/dx2 [N]; dW/dx0 is minus their sum
    T energy;
};

/// Local step of the membrane on a triangle: the distance of its deformation gradient to the projections.
/// @param F         deformation gradient; its columns are the stretched warp and weft
/// @param rest_inv  inverse rest edge matrix [1/m]
/// @param area      rest area [m^2]
template <typename T>
TOILE_HD MembraneResponse<T> project_membrane(const Mat32Of<T>& F, const Mat2Of<T>& rest_inv, const T& area,
                                              const MembraneWeights& weights)
{
    Mat32Of<T> yarn;
    for (int k = 0; k < 2; ++k) {
        const T length = square_root(F.col(k).squaredNorm());
        const T shortening = T(1.0) - T(1.0) / length;
        yarn.col(k) = select(length > T(0.0), shortening, T(0.0)) * F.col(k);
    }
    const Mat32Of<T> shear = F - closest_isometry<T>(F);

    MembraneResponse<T> response;
    response.energy = T(0.5) * area *
                      (T(weights.warp) * yarn.col(0).squaredNorm() +
                       T(weights.weft) * yarn.col(1).squaredNorm() + T(weights.shear) * shear.squaredNorm());
    Mat32Of<T> stress = T(weights.shear) * shear;
    stress.col(0) += T(weights.warp) * yarn.col(0);
    stress.col(1) += T(weights.weft) * yarn.col(1);
    response.corner_gradient.noalias() = stress.lazyProduct(rest_inv.transpose());
    response.corner_gradient *= area;
    return response;
}

/// F [-]: maps rest edges of a triangle to its edges at x [vertices] [m].
/// @param rest_inv  inverse rest edge matrix [1/m]
TOILE_HD inline Mat32 deformation_gradient(View<const Vec3> x, const Triangle& tri, const Mat2& rest_inv)
{
    Mat32 edges;
    edges.col(0) = x[tri[1]] - x[tri[0]];
    edges.col(1) = x[tri[2]] - x[tri[0]];
    return edges.lazyProduct(rest_inv);
}

/// Viscosity of fabrics that have none; see ViscousTriangles.
struct NoViscosity {
    TOILE_HD void add(int, const Mat32&, const Mat2&, double, MembraneResponse<double>&) const {}
    template <typename Curvature>
    TOILE_HD void add_curvature(int, const Mat32&, Curvature&) const
    {
    }
};

/// Gradients at two corners of a triangle in single precision, two loads of 16 bytes. Where the forces of
/// neighbours cancel, a vertex of cloth at 1e4 N/m keeps four digits of its weight.
struct CornerPair {
    PaddedVec3 column[2];

    TOILE_HD CornerPair& operator=(const Mat32& gradients)
    {
        for (int k = 0; k < 2; ++k)
            column[k] = padded(gradients.col(k));
        return *this;
    }
};

/// project_membrane() and viscosity for one triangle, as a GPU runs it; the CPU runs eight at a time
/// (membrane_lanes.h).
/// @tparam Corners    type of corner_gradient: Mat32 or CornerPair
/// @tparam Viscosity  NoViscosity or ViscousTriangles
template <typename Corners, typename Viscosity = NoViscosity>
struct ProjectMembraneTriangle {
    View<const Vec3> x;        ///< [vertices] positions [m]
    View<const Triangle> tri;  ///< [triangles] vertex indices
    View<const Mat2> rest_inv; ///< [triangles] inverse rest edge matrices [1/m]
    View<const double> area;   ///< [triangles] rest areas [m^2]
    View<const int> fabric;    ///< [triangles] into weights
    View<const MembraneWeights> weights;
    View<Corners> corner_gradient; ///< [triangles] out: dW/dx1, dW/dx2 [N]
    View<double> energy;           ///< [triangles] out: [J]
    Viscosity viscosity{};

    /// Inputs that no launch changes.
    struct Prologue {
        Triangle tri;
        Mat2 rest_inv;
        double area;
        MembraneWeights weights;
    };
    TOILE_HD Prologue prologue(int t) const { return {tri[t], rest_inv[t], area[t], weights[fabric[t]]}; }

    TOILE_HD void operator()(int t) const { (*this)(t, prologue(t)); }
    TOILE_HD void operator()(int t, const Prologue& local) const
    {
        const Mat32 F = deformation_gradient(x, local.tri, local.rest_inv);
        MembraneResponse<double> response =
            project_membrane<double>(F, local.rest_inv, local.area, local.weights);
        viscosity.add(t, F, local.rest_inv, local.area, response);
        energy[t] = response.energy;
        corner_gradient[t] = response.corner_gradient;
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

} // namespace toile::garment
