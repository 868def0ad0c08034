#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/bvh/box_block.h"
#include "collision/bvh/box_tree.h"
#include "collision/geometry/surface_edges.h"

namespace toile::collision {

/// Boxes of triangles, edges and vertices, in blocks of eight that belong to the leaves of a tree over the
/// triangles. An edge or a vertex belongs to the leaf of its lowest triangle.
class PrimitiveBoxes {
public:
    /// Primitives of one kind, sorted by leaf.
    struct Kind {
        std::vector<int> first_block; ///< [leaves + 1]
        std::vector<int> item;        ///< [8 blocks] -1: unused lane
        std::vector<BoxBlock> block;
        std::vector<std::uint8_t> wanted; ///< [blocks] one bit per lane

        bool is_wanted(int b, int lane) const { return (wanted[b] >> lane & 1) != 0; }
        int item_of(int b, int lane) const { return item[size_t(b) * BoxBlock::kCount + lane]; }
    };
    Kind triangles, edges, vertices;

    /// Assigns primitives to blocks; boxes stay empty.
    void assign(const BoxTree& tree, const SurfaceEdges& surface, View<const Triangle> corners);
};

} // namespace toile::collision
