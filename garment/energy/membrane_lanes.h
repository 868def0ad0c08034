#pragma once

#include <algorithm>

#include "core/pd/energy/energy.h"
#include "garment/energy/membrane_curvature.h"
#include "garment/energy/stretch_curvature.h"
#include "garment/energy/viscosity_kernels.h"

namespace toile::garment {

/// Deformation gradients of a block of eight triangles.
inline Mat32Of<Lanes> deformation_gradients(View<const Vec3> x, View<const Triangle> tri,
                                            const Mat2Of<Lanes>& rest_inv, int block)
{
    const int first = block * kLanes, count = tri.size();
    Mat32Of<Lanes> edges;
    for (int i = 0; i < 3; ++i) {
        const Lanes x0 = gather(first, count, [&](int t) { return x[tri[t][0]][i]; });
        for (int k = 0; k < 2; ++k)
            edges(i, k) = gather(first, count, [&](int t) { return x[tri[t][k + 1]][i]; }) - x0;
    }
    return edges.lazyProduct(rest_inv);
}

/// Viscosity of a step, eight triangles at a time; see viscous_response().
struct ViscousStep {
    ViscousWeights weights;
    View<const Lanes> share;              ///< [blocks] 1, but 0 for slivers: their strain is noise
    View<const GreenStrain<Lanes>> start; ///< [blocks] at the start of the step

    bool is_active() const { return !weights.are_zero() && !start.empty(); }
};

/// project_membrane() and viscosity for eight triangles at a time.
struct ProjectMembrane {
    View<const Vec3> x;                 ///< [vertices] positions [m]
    View<const Triangle> tri;           ///< [triangles] vertex indices
    View<const Mat2Of<Lanes>> rest_inv; ///< [blocks] inverse rest edge matrices [1/m]
    View<const Lanes> area;             ///< [blocks] rest areas [m^2]
    MembraneWeights weights;
    ViscousStep viscosity;
    View<Mat32> corner_gradient; ///< [triangles] out: dW/dx1, dW/dx2 [N]
    View<double> energy;         ///< [triangles] out: [J]

    void operator()(int block) const
    {
        const int first = block * kLanes, count = tri.size();
        const Mat32Of<Lanes> F = deformation_gradients(x, tri, rest_inv[block], block);
        MembraneResponse<Lanes> response = project_membrane<Lanes>(F, rest_inv[block], area[block], weights);
        if (viscosity.is_active()) {
            const MembraneResponse<Lanes> viscous =
                viscous_response<Lanes>(F, viscosity.start[block], rest_inv[block],
                                        viscosity.share[block] * area[block], viscosity.weights);
            response.energy += viscous.energy;
            response.corner_gradient += viscous.corner_gradient;
        }
        const int lanes = std::min(kLanes, count - first);
        for (int k = 0; k < lanes; ++k) {
            energy[first + k] = response.energy[k];
            for (int i = 0; i < 6; ++i)
                corner_gradient[first + k](i) = response.corner_gradient(i)[k];
        }
    }
};

/// membrane_curvature() for eight triangles at a time.
struct CurveMembrane {
    View<const Vec3> x;                 ///< [vertices] positions [m]
    View<const Triangle> tri;           ///< [triangles] vertex indices
    View<const Mat2Of<Lanes>> rest_inv; ///< [blocks] inverse rest edge matrices [1/m]
    MembraneWeights weights;
    ViscousStep viscosity;
    Definiteness definiteness;
    View<StretchCurvature> curvature; ///< [triangles] out

    void operator()(int block) const
    {
        const int first = block * kLanes, lanes = std::min(kLanes, tri.size() - first);
        const bool is_projected = definiteness == Definiteness::Projected;
        const Mat32Of<Lanes> F = deformation_gradients(x, tri, rest_inv[block], block);
        MembraneCurvature<Lanes> H = membrane_curvature<Lanes>(F, weights, is_projected);
        if (viscosity.is_active())
            add_viscous_curvature<Lanes>(F, viscosity.start[block], viscosity.share[block], viscosity.weights,
                                         is_projected, H);
        for (int k = 0; k < lanes; ++k)
            for (int i = 0; i < 9; ++i) {
                curvature[first + k].uu(i) = H.uu(i)[k];
                curvature[first + k].uv(i) = H.uv(i)[k];
                curvature[first + k].vv(i) = H.vv(i)[k];
            }
    }
};

} // namespace toile::garment
