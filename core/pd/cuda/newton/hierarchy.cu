#include "core/pd/cuda/newton/hierarchy.h"

#include "core/compute/cuda/teams.cuh"

namespace toile {

DeviceHierarchy::LevelArrays::LevelArrays(const CudaSpace& space, const ClusterHierarchy::Level& level)
    : cluster_of(space, "hierarchy/cluster_of"), first_of_cluster(space, "hierarchy/first_of_cluster"),
      end_of_cluster(space, "hierarchy/end_of_cluster"), block_of(space, "hierarchy/block_of"),
      slot_of(space, "hierarchy/slot_of"), first_of_block(space, "hierarchy/first_of_block"),
      transfer(space, "hierarchy/transfer"), block_count(level.block_count())
{
    cluster_of.upload(level.cluster_of);
    first_of_cluster.upload(level.first_of_cluster);
    end_of_cluster.upload(level.end_of_cluster);
    block_of.upload(level.block_of);
    slot_of.upload(level.slot_of);
    first_of_block.upload(level.first_of_block);
    transfer.upload(level.transfer);
}

HierarchyView::Level DeviceHierarchy::LevelArrays::view(int first_item) const
{
    return {cluster_of.view(), first_of_cluster.view(), end_of_cluster.view(), block_of.view(),
            slot_of.view(),    first_of_block.view(),   transfer.view(),       first_item};
}

DeviceHierarchy::DeviceHierarchy(const CudaSpace& space, const ClusterHierarchy& clusters)
    : space_(space), functions_on_host_(clusters.functions()), first_vertex_(space, "hierarchy/first_vertex"),
      vertices_(space, "hierarchy/vertices"), cluster_of_(space, "hierarchy/cluster_of_vertex"),
      level_of_item_(space, "hierarchy/level_of_item"), first_of_level_(space, "hierarchy/first_of_level"),
      functions_(space, "hierarchy/functions"), panels_(space, "hierarchy/panels"),
      inverses_(space, "hierarchy/inverses"), restricted_(space, "hierarchy/restricted"),
      solution_(space, "hierarchy/solution")
{
    first_vertex_.upload(clusters.first_vertex());
    vertices_.upload(clusters.vertices());
    cluster_of_.upload(clusters.cluster_of());
    functions_.upload(functions_on_host_);
    std::vector<int> level_of_item, first_of_level;
    int total = 0;
    for (const ClusterHierarchy::Level& level : clusters.levels()) {
        levels_.emplace_back(space, level);
        level_of_item.insert(level_of_item.end(), level.block_count(), int(levels_.size()) - 1);
        first_of_level.push_back(total);
        total += level.cluster_count;
        cluster_counts_.push_back(level.cluster_count);
    }
    level_of_item_.upload(level_of_item);
    first_of_level_.upload(first_of_level);
    panels_.resize((int(levels_.size()) - 1) * clusters.cluster_count() * HierarchyView::kPanel);
    inverses_.resize(level_of_item_.size() * HierarchyView::kMatrix);
    restricted_.resize(clusters.cluster_count() * HierarchyView::kUnknowns);
    solution_.resize(total * HierarchyView::kUnknowns);
}

HierarchyView DeviceHierarchy::view() const
{
    HierarchyView view{first_vertex_.view(),
                       vertices_.view(),
                       cluster_of_.view(),
                       functions_.view(),
                       level_of_item_.view(),
                       int(levels_.size()),
                       {}};
    int first_item = 0;
    for (size_t level = 0; level < levels_.size(); ++level) {
        view.levels[level] = levels_[level].view(first_item);
        first_item += levels_[level].block_count;
    }
    return view;
}

void DeviceHierarchy::set_fixed(const std::vector<unsigned char>& fixed)
{
    std::vector<PaddedVec3> functions = functions_on_host_;
    for (size_t i = 0; i < fixed.size(); ++i)
        if (fixed[i])
            functions[i] = PaddedVec3(0.0F);
    functions_.upload(functions);
}

void DeviceHierarchy::update(const SlicedHessian& hessian, const FrozenTerms& terms)
{
    const StageScope stage("newton/coarse");
    const HierarchyView clusters = view();
    inverses_.fill_zero();
    panels_.fill_zero();
    parallel_for_blocks<AssembleClusters::kThreads>(
        space_, "hierarchy/assemble", clusters.level_count * cluster_count(), AssembleClusters::kBytes,
        AssembleClusters{clusters, hessian, terms, inverses_.view(), panels_.view()});
    for (int level = 1; level < clusters.level_count; ++level) {
        const int size = cluster_count() * HierarchyView::kPanel;
        parallel_for(space_, "hierarchy/sum", cluster_counts_[level] * HierarchyView::kPanel,
                     SumClusters{clusters.levels[level], panels_.view().subview((level - 1) * size, size),
                                 inverses_.view()});
    }
    parallel_for_blocks<InvertMatrix::kThreads>(space_, "hierarchy/invert", level_of_item_.size(),
                                                InvertMatrix::kBytes, InvertMatrix{inverses_.view()});
}

void DeviceHierarchy::solve()
{
    parallel_for_blocks<MultiplyInverses::kThreads>(
        space_, "hierarchy/solve", MultiplyInverses::kParts * level_of_item_.size(), MultiplyInverses::kBytes,
        MultiplyInverses{view(), inverses_.view(), restricted_.view(), solution_.view(),
                         first_of_level_.view()});
}

ClusterFields DeviceHierarchy::fields()
{
    return {view(), restricted_.view(), solution_.view(), first_of_level_.view()};
}

} // namespace toile
