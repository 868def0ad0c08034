#pragma once

#include <algorithm>

#include "core/pd/energy/energy.h"
#include "garment/energy/membrane_curvature.h"
#include "garment/energy/stretch_curvature.h"

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

/// project_membrane() for eight triangles at a time.
struct ProjectMembrane {
    View<const Vec3> x;                 ///< [vertices] positions [m]
    View<const Triangle> tri;           ///< [triangles] vertex indices
    View<const Mat2Of<Lanes>> rest_inv; ///< [blocks] inverse rest edge matrices [1/m]
    View<const Lanes> area;             ///< [blocks] rest areas [m^2]
    MembraneWeights weights;
    View<Mat32> corner_gradient; ///< [triangles] out: dW/dx1, dW/dx2 [N]
    View<double> energy;         ///< [triangles] out: [J]

    void operator()(int block) const
    {
        const int first = block * kLanes, count = tri.size();
        const Mat32Of<Lanes> F = deformation_gradients(x, tri, rest_inv[block], block);
        const MembraneResponse<Lanes> response =
            project_membrane<Lanes>(F, rest_inv[block], area[block], weights);
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
    Definiteness definiteness;
    View<StretchCurvature> curvature; ///< [triangles] out

    void operator()(int block) const
    {
        const int first = block * kLanes, lanes = std::min(kLanes, tri.size() - first);
        const MembraneCurvature<Lanes> H =
            membrane_curvature<Lanes>(deformation_gradients(x, tri, rest_inv[block], block), weights,
                                      definiteness == Definiteness::Projected);
        for (int k = 0; k < lanes; ++k)
            for (int i = 0; i < 9; ++i) {
                curvature[first + k].uu(i) = H.uu(i)[k];
                curvature[first + k].uv(i) = H.uv(i)[k];
                curvature[first + k].vv(i) = H.vv(i)[k];
            }
    }
};

} // namespace toile::garment
