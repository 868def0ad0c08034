#pragma once

#include <array>

#include "core/pd/cuda/newton/hessian_entries.h"

namespace toile {

/// Adds the blocks of the elements at a pair of vertices (i, j) to the entries (i, j) and (j, i) of a
/// Hessian.
struct AddElementBlocks {
    View<const int> first;                    ///< [pairs + 1] into items
    View<const int> items;                    ///< 2 * block, plus 1 for the block of (j, i)
    View<const std::array<int, 2>> positions; ///< [pairs] of (i, j) and (j, i)
    HessianBlocks of_elements;                ///< [elements * of_element]
    int of_element;                           ///< blocks of an element
    View<const unsigned char> has_blocks;     ///< [elements]; empty: all have
    HessianBlocks blocks;                     ///< added to

    TOILE_HD void operator()(int pair) const
    {
        HessianBlocks::Block sum = HessianBlocks::Block::Zero();
        bool has_any = false;
        for (int k = first[pair]; k < first[pair + 1]; ++k) {
            const int of_element_block = items[k] / 2;
            if (!has_blocks.empty() && !has_blocks[of_element_block / of_element])
                continue;
            has_any = true;
            const HessianBlocks::Block block = of_elements[of_element_block];
            if (items[k] % 2 == 0)
                sum += block;
            else
                sum += block.transpose();
        }
        if (!has_any)
            return;
        blocks.add(positions[pair][0], sum);
        blocks.add(positions[pair][1], sum.transpose());
    }
};

} // namespace toile
