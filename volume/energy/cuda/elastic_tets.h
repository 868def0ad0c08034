#pragma once

#include <array>
#include <vector>

#include "core/pd/cuda/newton/hessian_entries.h"
#include "volume/energy/elastic_kernels.h"
#include "volume/mesh/tet_mesh.h"

namespace toile::volume {

/// Tetrahedra as kernels read them.
struct ElasticTets {
    View<const Tet> tets;
    View<const Mat3> rest_inv; ///< [tets] inverse rest edge matrices [1/m]
    View<const double> volume; ///< [tets] at rest [m^3]
    View<const Lame> lame;     ///< [tets]

    TOILE_HD Mat3 deformation_gradient(View<const Vec3> x, int t) const
    {
        const Vec3& x0 = x[tets[t][0]];
        Mat3 edges;
        for (int k = 0; k < 3; ++k)
            edges.col(k) = x[tets[t][k + 1]] - x0;
        return edges.lazyProduct(rest_inv[t]);
    }
};

/// elastic_response() of tetrahedron t.
struct ProjectTet {
    ElasticTets solid;
    View<const Vec3> x;         ///< [vertices] [m]
    View<Mat3> corner_gradient; ///< [tets] out: dW/dx1, dW/dx2, dW/dx3 [N]
    View<double> energy;        ///< [tets] out [J]

    TOILE_HD void operator()(int t) const
    {
        const ElasticResponse<double> response = elastic_response<double>(
            solid.deformation_gradient(x, t), solid.rest_inv[t], solid.volume[t], solid.lame[t]);
        corner_gradient[t] = response.corner_gradient;
        energy[t] = response.energy;
    }
};

/// Adds the gradients of the tetrahedra at vertex v.
struct GatherTets {
    View<const int> first;            ///< [vertices + 1]
    View<const int> corners;          ///< 4 * tet + corner, ascending per vertex
    View<const Mat3> corner_gradient; ///< [tets] from ProjectTet
    View<Vec3> gradient;              ///< [vertices] added to [N]

    TOILE_HD void operator()(int v) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[v]; k < first[v + 1]; ++k) {
            const Mat3& g = corner_gradient[corners[k] / 4];
            if (const int corner = corners[k] % 4; corner == 0)
                sum -= g.col(0) + g.col(1) + g.col(2);
            else
                sum += g.col(corner - 1);
        }
        gradient[v] += sum;
    }
};

/// Pairs of vertices in the order of CurveTet.
inline std::vector<std::array<int, 2>> pairs_of(View<const Tet> tets)
{
    std::vector<std::array<int, 2>> pairs;
    for (const Tet& tet : tets)
        for (int first = 0; first < 4; ++first)
            for (int second = first + 1; second < 4; ++second)
                pairs.push_back({tet[first], tet[second]});
    return pairs;
}

/// elastic_curvature() of tetrahedron t between its corners, projected.
struct CurveTet {
    static constexpr int kPairs = 6; ///< of corners
    ElasticTets solid;
    View<const Vec3> x;   ///< [vertices] [m]
    HessianBlocks blocks; ///< [6 tets] out [N/m]

    TOILE_HD void operator()(int t) const
    {
        const ElasticCurvature<double> H =
            elastic_curvature<double>(solid.deformation_gradient(x, t), solid.lame[t], true);
        const ElasticCorners<double> corners(H, solid.rest_inv[t], solid.volume[t]);
        int pair = kPairs * t;
        for (int first = 0; first < 4; ++first)
            for (int second = first + 1; second < 4; ++second)
                blocks.set(pair++, corners.block(first, second).cast<float>());
    }
};

} // namespace toile::volume
