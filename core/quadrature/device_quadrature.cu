#include "core/quadrature/device_quadrature.h"

#include <vector>

#include "core/backend/cuda/teams.cuh"

namespace toile {

namespace {

std::vector<float> single(View<const double> values) { return {values.begin(), values.end()}; }

/// Nodes that are in no leaf.
std::vector<int> others_of(View<const int> slots, int node_count)
{
    std::vector<unsigned char> is_known(node_count, 0);
    for (const int v : slots)
        if (v >= 0)
            is_known[v] = 1;
    std::vector<int> others;
    for (int v = 0; v < node_count; ++v)
        if (!is_known[v])
            others.push_back(v);
    return others;
}

} // namespace

DeviceQuadrature::DeviceQuadrature(const CudaSpace& space, const QuadratureTables& tables, int node_count,
                                   const std::vector<int>& first, const PackingAccuracy& packing)
    : DeviceQuadrature(space, tables.basis, DeviceKernelTable(space, tables.kernel), node_count, first,
                       packing)
{
}

DeviceQuadrature::DeviceQuadrature(const CudaSpace& space, const ClusterBasis& basis,
                                   DeviceKernelTable kernel, int node_count, const std::vector<int>& first,
                                   const PackingAccuracy& packing)
    : space_(space), kernel_(pack_table(space, std::move(kernel), basis.tree(), packing)),
      leaves_(space, "quadrature/leaves"), transfers_(space, "quadrature/transfers"),
      nodes_(space, "quadrature/nodes"), others_(space, "quadrature/others"),
      first_(space, "quadrature/first"),
      sources_(space, "quadrature/sources", int(first.size()) * basis.tree().nodes().size()),
      moments_(space, "quadrature/moments", int(first.size()) * basis.rank() * basis.tree().cluster_count())
{
    leaves_.upload(single(basis.leaves()));
    transfers_.upload(single(basis.transfers()));
    nodes_.upload(basis.tree().nodes());
    first_.upload(first);
    others_.upload(others_of(basis.tree().nodes(), node_count));

    const BasisView<double>& view = basis.view();
    basis_.rank = view.rank;
    basis_.leaf_count = view.leaf_count;
    std::copy(std::begin(view.first_of_level), std::end(view.first_of_level),
              std::begin(basis_.first_of_level));
    basis_.leaves = leaves_.view();
    basis_.transfers = transfers_.view();
}

std::size_t DeviceQuadrature::table_bytes() const
{
    return kernel_.packed.bytes() + kernel_.rest.bytes() +
           (std::size_t(leaves_.size()) + transfers_.size()) * sizeof(float);
}

void DeviceQuadrature::solve(View<const Vec3> b, View<Vec3> x)
{
    const StageScope stage("quadrature/solve");
    gather_moments(b);
    gather(b, x);
}

void DeviceQuadrature::gather_moments(View<const Vec3> b)
{
    if (basis_.rank == rank_of(Extent::Surface))
        climb<rank_of(Extent::Surface)>(b);
    else
        climb<rank_of(Extent::Volume)>(b);
}

template <int Rank>
void DeviceQuadrature::climb(View<const Vec3> b)
{
    if (basis_.leaf_count == 0)
        return;
    using FromLeaves = ClimbFromLeaves<Rank>;
    using FromLevel = ClimbFromLevel<Rank>;
    const int bodies = first_.size();
    const MomentsOfBodies<Rank> moments{basis_, moments_.view(), moments_.size() / (bodies * Rank)};
    const FromLeaves from_leaves{moments, nodes_.view(), first_.view(), b, sources_.view()};
    parallel_for_blocks<FromLeaves::kThreads>(space_, "quadrature/leaf_moments",
                                              bodies * from_leaves.blocks_of_body(), FromLeaves::kSharedBytes,
                                              from_leaves);

    // A block each for as many clusters as it has threads, until one is left.
    for (int level = from_leaves.levels(); level_size(basis_.leaf_count, level) > 1;) {
        int levels = 0;
        while (1 << levels < FromLevel::kNodes && level_size(basis_.leaf_count, level + levels) > 1)
            ++levels;
        const FromLevel from_level{moments, level, levels};
        parallel_for_blocks<FromLevel::kThreads>(space_, "quadrature/moments",
                                                 bodies * from_level.blocks_of_body(),
                                                 FromLevel::kSharedBytes, from_level);
        level += levels;
    }
}

void DeviceQuadrature::gather(View<const Vec3> b, View<Vec3> x)
{
    if (basis_.rank == rank_of(Extent::Surface))
        gather_leaves<rank_of(Extent::Surface)>(b, x);
    else
        gather_leaves<rank_of(Extent::Volume)>(b, x);
}

template <int Rank>
void DeviceQuadrature::gather_leaves(View<const Vec3> b, View<Vec3> x)
{
    const GatherLeafByTeam<Rank> leaves{kernel_.packed.view(),
                                        kernel_.rest.view(),
                                        sources_.view(),
                                        moments_.view(),
                                        nodes_.view(),
                                        others_.view(),
                                        first_.view(),
                                        basis_.leaf_count > ClimbFromLeaves<Rank>::kLeaves,
                                        b,
                                        x};
    constexpr int kTeam = GatherLeafByTeam<Rank>::kThreads;
    parallel_for_teams<kTeam>(space_, "quadrature/gather", leaves.teams(kTeam), leaves);
}

} // namespace toile
