#pragma once

#include "garment/energy/membrane_curvature.h"

namespace toile::garment {

/// Green strain (F^T F - I) / 2 of a triangle in material axes.
template <typename T>
struct GreenStrain {
    T uu, uv, vv;
};

template <typename T>
TOILE_HD GreenStrain<T> green_strain(const Mat32Of<T>& F)
{
    const T half(0.5), one(1.0);
    return {half * (F.col(0).squaredNorm() - one), half * F.col(0).dot(F.col(1)),
            half * (F.col(1).squaredNorm() - one)};
}

/// Viscous resistance to a change of strain during a step [N/m]: a time times a modulus over the step.
struct ViscousWeights {
    double warp = 0.0, weft = 0.0, shear = 0.0;

    TOILE_HD bool are_zero() const { return warp == 0.0 && weft == 0.0 && shear == 0.0; }

    /// Weights of a step of dt seconds, if these are of one second.
    ViscousWeights over(double dt) const { return {warp / dt, weft / dt, shear / dt}; }
};

/// Stress conjugate to the Green strain by a change of strain [N/m]; W's derivative by F is F stress.
template <typename T>
TOILE_HD GreenStrain<T> viscous_stress(const GreenStrain<T>& now, const GreenStrain<T>& start,
                                       const ViscousWeights& weights)
{
    return {T(weights.warp) * (now.uu - start.uu), T(2.0 * weights.shear) * (now.uv - start.uv),
            T(weights.weft) * (now.vv - start.vv)};
}

/// Dissipation potential of a triangle over a step, a function of strains alone: rigid motion costs nothing.
///
///   D = A/2 [ w_u dE_uu^2 + w_v dE_vv^2 + w_s (2 dE_uv)^2 ]
template <typename T>
TOILE_HD MembraneResponse<T> viscous_response(const Mat32Of<T>& F, const GreenStrain<T>& start,
                                              const Mat2Of<T>& rest_inv, const T& area,
                                              const ViscousWeights& weights)
{
    const GreenStrain<T> now = green_strain<T>(F);
    const GreenStrain<T> s = viscous_stress<T>(now, start, weights);
    MembraneResponse<T> response;
    response.energy =
        T(0.5) * area *
        (s.uu * (now.uu - start.uu) + T(2.0) * s.uv * (now.uv - start.uv) + s.vv * (now.vv - start.vv));
    Mat32Of<T> derivative;
    derivative.col(0) = s.uu * F.col(0) + s.uv * F.col(1);
    derivative.col(1) = s.uv * F.col(0) + s.vv * F.col(1);
    response.corner_gradient.noalias() = derivative.lazyProduct(rest_inv.transpose());
    response.corner_gradient *= area;
    return response;
}

/// Adds the second derivative of D per area.
/// @param share         [-] of the triangle's area that resists
/// @param is_projected  omits the stress's compression: positive semi-definite
template <typename T>
TOILE_HD void add_viscous_curvature(const Mat32Of<T>& F, const GreenStrain<T>& start, const T& share,
                                    const ViscousWeights& weights, bool is_projected, MembraneCurvature<T>& H)
{
    const T zero(0.0), one(1.0);
    GreenStrain<T> s = viscous_stress<T>(green_strain<T>(F), start, weights);
    if (is_projected) {
        // max(S, 0) = alpha S + beta I, through the eigenvalues mean +- radius.
        const T mean = T(0.5) * (s.uu + s.vv), half = T(0.5) * (s.uu - s.vv);
        const T radius = square_root(half * half + s.uv * s.uv);
        const T high = mean + radius, low = mean - radius;
        const T high_cut = select(high > zero, high, zero), low_cut = select(low > zero, low, zero);
        const auto is_split = radius > zero;
        const T alpha = select(is_split, (high_cut - low_cut) / select(is_split, T(2.0) * radius, one), zero);
        const T beta = low_cut - alpha * low;
        s = {alpha * s.uu + beta, alpha * s.uv, alpha * s.vv + beta};
    }
    const Vec3Of<T> u = F.col(0), v = F.col(1);
    const T warp = share * T(weights.warp), weft = share * T(weights.weft), shear = share * T(weights.shear);
    H.uu += warp * (u * u.transpose()) + shear * (v * v.transpose());
    H.uv += shear * (v * u.transpose());
    H.vv += weft * (v * v.transpose()) + shear * (u * u.transpose());
    for (int i = 0; i < 3; ++i) {
        H.uu(i, i) += share * s.uu;
        H.uv(i, i) += share * s.uv;
        H.vv(i, i) += share * s.vv;
    }
}

/// Viscosity of a step, one triangle at a time as a GPU runs it; the CPU's is ViscousStep.
struct ViscousTriangles {
    View<const int> fabric; ///< [triangles] into weights; those of slivers are 0: their strain is noise
    View<const ViscousWeights> weights;
    View<const GreenStrain<double>> start; ///< [triangles] at the start of the step

    TOILE_HD void add(int t, const Mat32& F, const Mat2& rest_inv, double area,
                      MembraneResponse<double>& response) const
    {
        const MembraneResponse<double> viscous =
            viscous_response<double>(F, start[t], rest_inv, area, weights[fabric[t]]);
        response.energy += viscous.energy;
        response.corner_gradient += viscous.corner_gradient;
    }
    TOILE_HD void add_curvature(int t, const Mat32& F, MembraneCurvature<double>& H) const
    {
        add_viscous_curvature<double>(F, start[t], 1.0, weights[fabric[t]], true, H);
    }
};

/// Strain at the start of a step, for ViscousTriangles.
struct StrainOfTriangle {
    View<const Vec3> x;              ///< [vertices] [m]
    View<const Triangle> tri;        ///< [triangles] vertex indices
    View<const Mat2> rest_inv;       ///< [triangles] inverse rest edge matrices [1/m]
    View<GreenStrain<double>> start; ///< [triangles] out

    TOILE_HD void operator()(int t) const
    {
        start[t] = green_strain<double>(deformation_gradient(x, tri[t], rest_inv[t]));
    }
};

} // namespace toile::garment
