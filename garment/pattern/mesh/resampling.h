#pragma once

#include <vector>

#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// Vertices of a fine mesh as points on the triangles of a coarse mesh of the same pattern.
///
///   value(v) = sum_k weights[v][k] * coarse value(triangles[triangle[v]][k])
///
/// A vertex inside a panel lies in its triangle there, or has the nearest point of the nearest one: weights
/// are never negative. A vertex on an edge is interpolated by arc length between the two coarse vertices
/// beside it. Both sides of a seam then have the same weights: what is closed stays closed.
struct Resampling {
    std::vector<int> triangle; ///< [fine vertices] index into coarse.triangles
    std::vector<Vec3> weights; ///< [fine vertices] [-] not negative, sum 1

    /// Interpolates values of the coarse vertices.
    /// @param coarse  [coarse vertices]
    /// @return [fine vertices]
    template <typename T>
    std::vector<T> apply(const PatternMesh& coarse_mesh, const std::vector<T>& coarse) const
    {
        std::vector<T> fine;
        fine.reserve(triangle.size());
        for (size_t v = 0; v < triangle.size(); ++v) {
            const Triangle& t = coarse_mesh.triangles[triangle[v]];
            const Vec3& w = weights[v];
            fine.push_back(w[0] * coarse[t[0]] + w[1] * coarse[t[1]] + w[2] * coarse[t[2]]);
        }
        return fine;
    }
};

/// @throws InvalidUse unless both are meshes of one pattern
Resampling resample(const PatternMesh& coarse, const PatternMesh& fine);

} // namespace toile::garment
