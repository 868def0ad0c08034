#pragma once

#include <algorithm>

#include "garment/energy/membrane_kernels.h"

namespace toile {

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
        Mat32Of<Lanes> edges;
        for (int i = 0; i < 3; ++i) {
            const Lanes x0 = gather(first, count, [&](int t) { return x[tri[t][0]][i]; });
            for (int k = 0; k < 2; ++k)
                edges(i, k) = gather(first, count, [&](int t) { return x[tri[t][k + 1]][i]; }) - x0;
        }
        const Mat32Of<Lanes> F = edges.lazyProduct(rest_inv[block]);
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

} // namespace toile
