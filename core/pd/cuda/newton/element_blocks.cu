#include "core/pd/cuda/newton/element_blocks.h"

#include "core/compute/cuda/parallel.cuh"
#include "core/pd/cuda/newton/pair_lists.h"

namespace toile {

DeviceElementBlocks::DeviceElementBlocks(const CudaSpace& space, const std::string& name)
    : space_(space), first_(space, name + "/pair_first"), items_(space, name + "/pair_blocks"),
      positions_(space, name + "/pair_positions"), first_part_(space, name + "/element_blocks"),
      second_part_(space, name + "/element_blocks"), last_part_(space, name + "/element_blocks")
{
}

void DeviceElementBlocks::find_entries(const std::vector<std::array<int, 2>>& pairs, int of_element,
                                       const HessianPattern& pattern)
{
    const PairLists lists(pairs, [&](int i, int j) { return pattern.block_position(i, j); });
    of_element_ = of_element;
    first_.upload(lists.first);
    items_.upload(lists.items);
    positions_.upload(lists.positions);
    first_part_.resize(int(pairs.size()));
    second_part_.resize(int(pairs.size()));
    last_part_.resize(int(pairs.size()));
}

HessianBlocks DeviceElementBlocks::of_elements()
{
    return {first_part_.view(), second_part_.view(), last_part_.view()};
}

void DeviceElementBlocks::add_to(const HessianBlocks& blocks, std::string_view name,
                                 View<const unsigned char> has_blocks)
{
    parallel_for(space_, name, positions_.size(),
                 AddElementBlocks{first_.view(), items_.view(), positions_.view(), of_elements(), of_element_,
                                  has_blocks, blocks});
}

} // namespace toile
