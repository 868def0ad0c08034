#include "core/quadrature/quadrature_operator.h"

#include <algorithm>

#include "core/compute/parallel.h"
#include "core/quadrature/clusters/gather_leaf.h"

namespace toile {

/// Computes P_C^T b for all clusters, leaves first.
void QuadratureOperator::gather_moments(View<const Vec3> b, View<Vec3f> moments) const
{
    const ClusterTree& tree = tables_->tree;
    const ClusterBasis& basis = tables_->basis;
    const View<const int> nodes = tree.nodes();
    const auto value = [&](int slot) { return nodes[slot] >= 0 ? b[nodes[slot]] : Vec3(Vec3::Zero()); };
    thread_local std::vector<Vec3> sums;
    sums.resize(moments.size());
    const View<Vec3> out(sums);
    for (int level = 0; level < tree.level_count(); ++level)
        parallel_for(
            kCpu, "quadrature/moments", tree.level_size(level),
            [&](int c) { basis.gather(level, c, Vec3(Vec3::Zero()), value, out); }, kLeafGrain);
    for (int i = 0; i < moments.size(); ++i)
        moments[i] = sums[i].cast<float>();
}

void QuadratureOperator::solve(View<const Vec3> b, View<Vec3> x) const
{
    const StageScope stage("quadrature/solve");
    if (x.data() != b.data())
        std::copy(b.begin(), b.end(), x.begin());
    parallel_isolated(kCpu, [&] { apply(b, x); });
}

void QuadratureOperator::apply(View<const Vec3> b, View<Vec3> x) const
{
    const ClusterTree& tree = tables_->tree;
    const int rank = tables_->basis.rank();
    thread_local std::vector<Vec3f> moments, sources;
    moments.resize(size_t(rank) * tree.cluster_count());
    sources.resize(tree.nodes().size());
    gather_moments(b, moments);
    for (int slot = 0; slot < int(sources.size()); ++slot) {
        const int v = tree.nodes()[slot];
        sources[slot] = v >= 0 ? Vec3f(b[v].cast<float>()) : Vec3f(Vec3f::Zero());
    }
    if (rank == rank_of(Extent::Surface))
        gather<rank_of(Extent::Surface)>(sources, moments, x);
    else
        gather<rank_of(Extent::Volume)>(sources, moments, x);
}

template <int Rank>
void QuadratureOperator::gather(View<const Vec3f> sources, View<const Vec3f> moments, View<Vec3> x) const
{
    const GatherLeaf<Rank> kernel{tables_->kernel.view(), sources, moments, tables_->tree.nodes(), x};
    parallel_for(kCpu, "quadrature/gather", tables_->tree.leaf_count(), kernel, kLeafGrain);
}

} // namespace toile
