#include "core/pd/cuda/newton/hierarchy.h"

#include "core/compute/cuda/teams.cuh"

namespace toile {

namespace {

/// Rows of the matrices of a HierarchyView.
std::vector<int> matrix_sizes(const ClusterHierarchy& clusters)
{
    std::vector<int> sizes;
    const auto add = [&](const std::vector<int>& first) {
        for (size_t k = 0; k + 1 < first.size(); ++k)
            sizes.push_back(clusters.unknown_count() * (first[k + 1] - first[k]));
    };
    add(clusters.first_member());
    add(clusters.first_region());
    return sizes;
}

} // namespace

DeviceHierarchy::DeviceHierarchy(const CudaSpace& space, const ClusterHierarchy& clusters)
    : space_(space), functions_of_cluster_(clusters.function_count()),
      functions_on_host_(clusters.functions()), first_vertex_(space, "hierarchy/first_vertex"),
      vertices_(space, "hierarchy/vertices"), cluster_of_(space, "hierarchy/cluster_of"),
      functions_(space, "hierarchy/functions"), first_neighbour_(space, "hierarchy/first_neighbour"),
      neighbours_(space, "hierarchy/neighbours"), first_member_(space, "hierarchy/first_member"),
      first_copy_(space, "hierarchy/first_copy"), members_(space, "hierarchy/members"),
      copies_(space, "hierarchy/copies"), first_region_(space, "hierarchy/first_region"),
      component_of_(space, "hierarchy/component_of"), region_of_(space, "hierarchy/region_of"),
      transfers_(space, "hierarchy/transfers"), clusters_of_region_(space, "hierarchy/clusters_of_region"),
      inverses_(space, matrix_sizes(clusters)),
      couplings_(space, "hierarchy/couplings",
                 int(clusters.neighbours().size()) * clusters.unknown_count() * clusters.unknown_count()),
      restricted_(space, "hierarchy/restricted", clusters.cluster_count() * clusters.unknown_count()),
      to_regions_(space, "hierarchy/to_regions", clusters.cluster_count() * clusters.unknown_count()),
      of_copies_(space, "hierarchy/of_copies", int(clusters.copies().size()) * clusters.unknown_count()),
      of_regions_(space, "hierarchy/of_regions", clusters.region_count() * clusters.unknown_count())
{
    first_vertex_.upload(clusters.first_vertex());
    vertices_.upload(clusters.vertices());
    cluster_of_.upload(clusters.cluster_of());
    functions_.upload(functions_on_host_);
    first_neighbour_.upload(clusters.first_neighbour());
    neighbours_.upload(clusters.neighbours());
    first_member_.upload(clusters.first_member());
    first_copy_.upload(clusters.first_copy());
    members_.upload(clusters.members());
    copies_.upload(clusters.copies());
    first_region_.upload(clusters.first_region());
    component_of_.upload(clusters.component_of());
    region_of_.upload(clusters.region_of());
    transfers_.upload(clusters.transfers());
    clusters_of_region_.upload(clusters.clusters_of_region());
}

HierarchyView DeviceHierarchy::view()
{
    return {functions_of_cluster_, first_vertex_.view(),    vertices_.view(),   cluster_of_.view(),
            functions_.view(),     first_neighbour_.view(), neighbours_.view(), first_member_.view(),
            first_copy_.view(),    members_.view(),         copies_.view(),     first_region_.view(),
            component_of_.view(),  region_of_.view(),       transfers_.view(),  clusters_of_region_.view(),
            inverses_.view()};
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
    inverses_.entries().fill_zero();
    parallel_for_blocks<AssembleClusters::kThreads>(
        space_, "hierarchy/assemble", cluster_count(), AssembleClusters::kBytes,
        AssembleClusters{clusters, hessian, terms, couplings_.view()});
    parallel_for_blocks<AssembleRegions::kThreads>(space_, "hierarchy/assemble_regions", component_of_.size(),
                                                   0, AssembleRegions{clusters, couplings_.view()});
    inverses_.invert();
}

void DeviceHierarchy::solve()
{
    const HierarchyView clusters = view();
    parallel_for_blocks<MultiplyInverses::kThreads>(
        space_, "hierarchy/solve", clusters.matrices.tile_rows.size(), MultiplyInverses::kBytes,
        MultiplyInverses{clusters, restricted_.view(), to_regions_.view(), of_copies_.view(),
                         of_regions_.view()});
}

ClusterFields DeviceHierarchy::fields()
{
    return {view(), restricted_.view(), to_regions_.view(), of_copies_.view(), of_regions_.view()};
}

} // namespace toile
