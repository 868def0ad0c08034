#include "core/quadrature/cuda/packing.h"

#include <algorithm>
#include <vector>

#include "core/compute/cuda/parallel.cuh"
#include "core/compute/cuda/scan.h"
#include "core/quadrature/packing_kernels.h"

namespace toile {

namespace {

/// Maximum of H_ii of every leaf.
std::vector<double> largest_diagonal(const ClusterTree& tree, View<const double> diagonal)
{
    std::vector<double> largest(tree.leaf_count(), 0.0);
    for (int slot = 0; slot < tree.nodes().size(); ++slot)
        if (const int v = tree.nodes()[slot]; v >= 0)
            largest[slot / ClusterTree::kLeaf] = std::max(largest[slot / ClusterTree::kLeaf], diagonal[v]);
    return largest;
}

/// Output positions of the entries of one list.
class Split {
public:
    Split(const CudaSpace& space, const EntryList& list, const PackingRule& rule)
        : count_(list.source.size()), chosen_(space, "packing/chosen", count_ + 1),
          before_(space, "packing/before", count_ + 1)
    {
        DeviceScratch scratch(space, "packing/scratch");
        chosen_.fill_zero(); // the last item, for the total, is no entry
        parallel_for(space, "packing/choose", count_, ChooseToPack{list, rule, chosen_.view()});
        exclusive_scan(space, "packing/before", chosen_.view(), before_.view(), scratch);
        packed_count_ = int(before_.downloaded().back());
    }

    PackedSlots slots() const { return {chosen_.view(), before_.view()}; }
    int packed_count() const { return packed_count_; }
    int rest_count() const { return count_ - packed_count_; }

private:
    int count_;
    DeviceArray<int> chosen_;
    DeviceArray<long> before_;
    int packed_count_ = 0;
};

void pack_near(const CudaSpace& space, const DeviceKernelTable& table, const PackingRule& rule,
               PackedTable& out)
{
    const EntryList list = EntryList::near(table.view());
    const Split split(space, list, rule);
    out.packed.near_leaf.resize(split.packed_count());
    out.packed.near_codes.resize(split.packed_count() * ClusterTree::kLeaf * PackedView::kWords);
    out.packed.near_scales.resize(split.packed_count() * 2);
    out.rest.near_leaf.resize(split.rest_count());
    out.rest.near_weights.resize(split.rest_count() * KernelTable::kNearWeights);
    parallel_for(
        space, "packing/near_firsts", list.first.size(),
        SplitFirsts{split.slots(), list.first, out.packed.near_first.view(), out.rest.near_first.view()});
    parallel_for(space, "packing/near", list.source.size(),
                 SplitEntry{list, split.slots(), true, out.packed.near_leaf.view(),
                            out.packed.near_codes.view(), out.packed.near_scales.view(),
                            out.rest.near_leaf.view(), out.rest.near_weights.view()});
    space.synchronise();
}

void pack_far(const CudaSpace& space, const DeviceKernelTable& table, const PackingRule& rule,
              PackedTable& out)
{
    const EntryList list = EntryList::far(table.view(), table.rank);
    const Split split(space, list, rule);
    out.packed.far_cluster.resize(split.packed_count());
    out.packed.far_codes.resize(split.packed_count() * table.rank * PackedView::kWords);
    out.packed.far_scales.resize(split.packed_count() * (table.rank + 1));
    out.rest.far_cluster.resize(split.rest_count());
    out.rest.far_weights.resize(split.rest_count() * table.rank * KernelTable::kTargets);
    parallel_for(
        space, "packing/far_firsts", list.first.size(),
        SplitFirsts{split.slots(), list.first, out.packed.far_first.view(), out.rest.far_first.view()});
    parallel_for(space, "packing/far", list.source.size(),
                 SplitEntry{list, split.slots(), false, out.packed.far_cluster.view(),
                            out.packed.far_codes.view(), out.packed.far_scales.view(),
                            out.rest.far_cluster.view(), out.rest.far_weights.view()});
    space.synchronise();
}

} // namespace

DevicePackedLists::DevicePackedLists(const CudaSpace& space, int leaf_count)
    : near_first(space, "quadrature/packed_near_first", leaf_count + 1),
      near_leaf(space, "quadrature/packed_near_leaf"), near_codes(space, "quadrature/packed_near_codes"),
      near_scales(space, "quadrature/packed_near_scales"),
      far_first(space, "quadrature/packed_far_first", leaf_count + 1),
      far_cluster(space, "quadrature/packed_far_cluster"), far_codes(space, "quadrature/packed_far_codes"),
      far_scales(space, "quadrature/packed_far_scales")
{
    near_first.fill_zero();
    far_first.fill_zero();
}

std::size_t DevicePackedLists::bytes() const
{
    const std::size_t numbers = std::size_t(near_first.size()) + near_leaf.size() + near_codes.size() +
                                near_scales.size() + far_first.size() + far_cluster.size() +
                                far_codes.size() + far_scales.size();
    return numbers * sizeof(float);
}

PackedTable pack_table(const CudaSpace& space, DeviceKernelTable table, const ClusterTree& tree,
                       const PackingAccuracy& accuracy)
{
    const int leaves = tree.leaf_count();
    if (accuracy.diagonal.empty() || leaves == 0)
        return {DevicePackedLists(space, leaves), std::move(table)};
    DeviceArray<double> limits(space, "packing/limits"), largest(space, "packing/largest_diagonal");
    limits.upload(far_limits(tree, accuracy.diagonal, accuracy.tolerance));
    largest.upload(largest_diagonal(tree, accuracy.diagonal));
    const PackingRule rule{limits.view(), largest.view()};
    PackedTable out{DevicePackedLists(space, leaves), DeviceKernelTable(space, table.rank, leaves)};
    pack_near(space, table, rule, out);
    pack_far(space, table, rule, out);
    return out;
}

} // namespace toile
