#include "garment/energy/cuda/side_blocks.h"

#include "core/compute/cuda/parallel.cuh"
#include "garment/energy/cuda/pair_lists.h"

namespace toile::garment {

DeviceSideBlocks::DeviceSideBlocks(const CudaSpace& space, const std::string& name)
    : space_(space), first_(space, name + "/edge_first"), items_(space, name + "/edge_sides"),
      positions_(space, name + "/edge_positions"), first_of_side_(space, name + "/side_blocks"),
      second_of_side_(space, name + "/side_blocks"), last_of_side_(space, name + "/side_blocks")
{
}

void DeviceSideBlocks::find_entries(View<const Triangle> triangles, const HessianPattern& pattern)
{
    std::vector<std::array<int, 2>> sides;
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            sides.push_back({t[k], t[(k + 1) % 3]});
    const PairLists edges(sides, [&](int i, int j) { return pattern.block_position(i, j); });
    first_.upload(edges.first);
    items_.upload(edges.items);
    positions_.upload(edges.positions);
    first_of_side_.resize(int(sides.size()));
    second_of_side_.resize(int(sides.size()));
    last_of_side_.resize(int(sides.size()));
}

HessianBlocks DeviceSideBlocks::sides()
{
    return {first_of_side_.view(), second_of_side_.view(), last_of_side_.view()};
}

void DeviceSideBlocks::add_to(const HessianBlocks& blocks, std::string_view name,
                              View<const unsigned char> has_sides)
{
    parallel_for(space_, name, positions_.size(),
                 AddSideBlocks{first_.view(), items_.view(), positions_.view(), sides(), has_sides, blocks});
}

} // namespace toile::garment
