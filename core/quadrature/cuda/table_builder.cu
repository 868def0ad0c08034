#include "core/quadrature/cuda/table_builder.h"

#include "core/compute/cuda/parallel.cuh"

namespace toile {

void DeviceTableBuilder::gather_moments()
{
    const int columns = block_.count * ClusterTree::kLeaf;
    for (int level = 0; level < basis_.tree().level_count(); ++level)
        parallel_for(space_, "tables/moments", basis_.tree().level_size(level) * columns,
                     GatherColumns{tree_, slots(), clusters(), level, columns});
}

void DeviceTableBuilder::find_entries()
{
    parallel_for(
        space_, "tables/find", parts(),
        FindEntries{tree_, {nodes_.view(), diagonal_.view(), limits_.view()}, clusters(), block_, entries()});
}

void DeviceTableBuilder::count_entries()
{
    const int count = parts() + 1;
    exclusive_scan(space_, "tables/near_sums", near_counts_.view().subview(0, count),
                   near_sums_.view().subview(0, count), scratch_);
    exclusive_scan(space_, "tables/far_sums", far_counts_.view().subview(0, count),
                   far_sums_.view().subview(0, count), scratch_);
    parallel_for(space_, "tables/count", totals_.size(), CountEntries{offsets(), totals_.view()});
    totals_.download(totals_on_host_.view());
}

void DeviceTableBuilder::write_lists(int near_count, int far_count)
{
    constexpr int kTargets = KernelTable::kTargets;
    parallel_for(space_, "tables/firsts", block_.count + 1,
                 WriteFirsts{offsets(), block_, table_.near_first.view(), table_.far_first.view()});
    parallel_for(space_, "tables/entries", parts(),
                 WriteEntries{entries(), offsets(), table_.near_leaf.view(), table_.far_cluster.view()});
    const KernelView lists = table_.view();
    parallel_for(space_, "tables/near_weights", near_count * kTargets,
                 WriteNearWeights{slots(), block_, near_entries_, lists.near_first, lists.near_leaf,
                                  table_.near_weights.view()});
    parallel_for(space_, "tables/far_weights", far_count * kTargets,
                 WriteFarWeights{clusters(), block_, far_entries_, lists.far_first, lists.far_cluster,
                                 table_.far_weights.view()});
}

} // namespace toile
