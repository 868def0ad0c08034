#pragma once

#include <array>
#include <vector>

#include "core/pd/cuda/newton/hessian_entries.h"
#include "garment/energy/stretch_curvature.h"

namespace toile::garment {

/// Stores the blocks between corners k and k + 1 of triangle t, its second derivative off the diagonal.
/// @tparam Curvature  StretchCurvature or MembraneCurvature<double>
/// @param rest_inv    inverse rest edge matrix [1/m]
/// @param area        rest area [m^2]
/// @param sides       [3 * triangles] out, by 3 * triangle + k
template <typename Curvature>
TOILE_HD void set_sides(const Curvature& H, const Mat2& rest_inv, double area, int t,
                        const HessianBlocks& sides)
{
    for (int k = 0; k < 3; ++k) {
        const Mat3 block = CornerBlocks(H, rest_inv, area, k).with(k < 2 ? k + 1 : 0);
        sides.set(3 * t + k, block.cast<float>());
    }
}

/// Pairs of vertices in the order of set_sides().
inline std::vector<std::array<int, 2>> sides_of(View<const Triangle> triangles)
{
    std::vector<std::array<int, 2>> sides;
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            sides.push_back({t[k], t[(k + 1) % 3]});
    return sides;
}

} // namespace toile::garment
