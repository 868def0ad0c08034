#pragma once

#include <array>

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

/// Adds the blocks of the triangles at an edge (i, j) to the entries (i, j) and (j, i) of a Hessian.
struct AddSideBlocks {
    View<const int> first;                    ///< [edges + 1] into items
    View<const int> items;                    ///< 2 * side, plus 1 where the side runs from j to i
    View<const std::array<int, 2>> positions; ///< [edges] of (i, j) and (j, i)
    HessianBlocks sides;                      ///< from set_sides()
    View<const unsigned char> has_sides;      ///< [triangles]; empty: all have
    HessianBlocks blocks;                     ///< added to

    TOILE_HD void operator()(int e) const
    {
        HessianBlocks::Block sum = HessianBlocks::Block::Zero();
        bool has_any = false;
        for (int k = first[e]; k < first[e + 1]; ++k) {
            const int side = items[k] / 2;
            if (!has_sides.empty() && !has_sides[side / 3])
                continue;
            has_any = true;
            const HessianBlocks::Block block = sides[side];
            if (items[k] % 2 == 0)
                sum += block;
            else
                sum += block.transpose();
        }
        if (!has_any)
            return;
        blocks.add(positions[e][0], sum);
        blocks.add(positions[e][1], sum.transpose());
    }
};

} // namespace toile::garment
