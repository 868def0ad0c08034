#include "core/quadrature/device_quadrature.h"

#include <vector>

#include "core/backend/cuda/teams.cuh"

namespace toile {

namespace {

/// Targets that a thread adds up at once: one load of 16 bytes of weights. With one or two, 10 000 vertices
/// take a fifth to two fifths longer; 50 000 take the same, for their tables come from memory.
constexpr int kWidth = 4;

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
                                   const std::vector<int>& first)
    : space_(space), leaves_(space, "quadrature/leaves"), transfers_(space, "quadrature/transfers"),
      nodes_(space, "quadrature/nodes"), others_(space, "quadrature/others"),
      first_(space, "quadrature/first"), near_first_(space, "quadrature/near_first"),
      near_leaf_(space, "quadrature/near_leaf"), far_first_(space, "quadrature/far_first"),
      far_cluster_(space, "quadrature/far_cluster"), near_weights_(space, "quadrature/near_weights"),
      far_weights_(space, "quadrature/far_weights"),
      sources_(space, "quadrature/sources", int(first.size()) * tables.tree.nodes().size()),
      moments_(space, "quadrature/moments",
               int(first.size()) * tables.basis.rank() * tables.tree.cluster_count())
{
    leaves_.upload(single(tables.basis.leaves()));
    transfers_.upload(single(tables.basis.transfers()));
    nodes_.upload(tables.tree.nodes());
    first_.upload(first);
    others_.upload(others_of(tables.tree.nodes(), node_count));
    near_first_.upload(tables.kernel.near_first);
    near_leaf_.upload(tables.kernel.near_leaf);
    near_weights_.upload(tables.kernel.near_weights);
    far_first_.upload(tables.kernel.far_first);
    far_cluster_.upload(tables.kernel.far_cluster);
    far_weights_.upload(tables.kernel.far_weights);

    const BasisView<double>& basis = tables.basis.view();
    basis_.rank = basis.rank;
    basis_.leaf_count = basis.leaf_count;
    std::copy(std::begin(basis.first_of_level), std::end(basis.first_of_level),
              std::begin(basis_.first_of_level));
    basis_.leaves = leaves_.view();
    basis_.transfers = transfers_.view();
}

KernelView DeviceQuadrature::kernel() const
{
    return {near_first_.view(), near_leaf_.view(),   near_weights_.view(),
            far_first_.view(),  far_cluster_.view(), far_weights_.view()};
}

std::size_t DeviceQuadrature::table_bytes() const
{
    const std::size_t numbers = std::size_t(near_weights_.size()) + far_weights_.size() + leaves_.size() +
                                transfers_.size() + near_leaf_.size() + far_cluster_.size() +
                                near_first_.size() + far_first_.size();
    return numbers * sizeof(float);
}

void DeviceQuadrature::solve(View<const Vec3> b, View<Vec3> x)
{
    const StageScope stage("quadrature/solve");
    gather_moments(b);
    gather(b, x);
}

void DeviceQuadrature::gather_moments(View<const Vec3> b)
{
    const int bodies = first_.size();
    parallel_for(space_, "quadrature/sort", sources_.size(),
                 SortIntoSlots{nodes_.view(), first_.view(), b, sources_.view()});
    parallel_climb(space_, "quadrature/moments", bodies, basis_.leaf_count, basis_.rank,
                   ClimbMoments{basis_, sources_.view(), moments_.view(), nodes_.size(),
                                moments_.size() / (bodies * basis_.rank)});
}

void DeviceQuadrature::gather(View<const Vec3> b, View<Vec3> x)
{
    if (basis_.rank == rank_of(Extent::Surface))
        gather_leaves<rank_of(Extent::Surface)>(x);
    else
        gather_leaves<rank_of(Extent::Volume)>(x);
    parallel_for(space_, "quadrature/others", first_.size() * others_.size(),
                 CopyOthers{others_.view(), first_.view(), b, x});
}

template <int Rank>
void DeviceQuadrature::gather_leaves(View<Vec3> x)
{
    parallel_for_teams(space_, "quadrature/gather", first_.size() * basis_.leaf_count,
                       GatherLeafByTeam<Rank, kWidth>{kernel(), sources_.view(), moments_.view(),
                                                      nodes_.view(), first_.view(), x});
}

} // namespace toile
