#include "collision/self/primitive_boxes.h"

namespace toile::collision {

namespace {

/// Closes a leaf: fills its last block with empty lanes.
void close_leaf(PrimitiveBoxes::Kind& kind)
{
    const size_t blocks = lane_blocks(int(kind.item.size()));
    kind.item.resize(blocks * BoxBlock::kCount, -1);
    kind.first_block.push_back(int(blocks));
}

void make_blocks(PrimitiveBoxes::Kind& kind)
{
    kind.block.resize(kind.item.size() / BoxBlock::kCount);
    kind.wanted.assign(kind.block.size(), 0);
    for (BoxBlock& block : kind.block)
        for (int lane = 0; lane < BoxBlock::kCount; ++lane)
            block.set(lane, Box());
}

} // namespace

void PrimitiveBoxes::assign(const BoxTree& tree, const SurfaceEdges& surface, View<const Triangle> corners)
{
    for (Kind* kind : {&triangles, &edges, &vertices}) {
        kind->first_block = {0};
        kind->item.clear();
    }
    const SurfaceEdgesView edges_of = view_of(surface);
    for (int leaf = 0; leaf < tree.leaf_count(); ++leaf) {
        for (const int t : tree.items_of(leaf)) {
            triangles.item.push_back(t);
            for (int k = 0; k < 3; ++k) {
                const int e = surface.triangle_edge[t][k];
                const int v = corners[t][k];
                if (edges_of.is_met_first(e, t, k))
                    edges.item.push_back(e);
                if (surface.corners_of_vertex.of(v)[0] == 3 * t + k)
                    vertices.item.push_back(v);
            }
        }
        for (Kind* kind : {&triangles, &edges, &vertices})
            close_leaf(*kind);
    }
    for (Kind* kind : {&triangles, &edges, &vertices})
        make_blocks(*kind);
}

} // namespace toile::collision
