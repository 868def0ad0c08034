#pragma once

/// The kernels of DeviceQuadrature around any source of right-hand sides and any sink of solutions. Included
/// by .cu files, as parallel.cuh.

#include "core/backend/cuda/teams.cuh"
#include "core/quadrature/device_quadrature.h"

namespace toile {

template <typename Source>
void DeviceQuadrature::begin_solve(Operators all, const Source& source)
{
    climb<rank_of(Extent::Surface)>(all, source);
    climb<rank_of(Extent::Volume)>(all, source);
}

template <typename Sink>
void DeviceQuadrature::end_solve(Operators all, const Sink& sink)
{
    gather_leaves<rank_of(Extent::Surface)>(all, sink);
    gather_leaves<rank_of(Extent::Volume)>(all, sink);
}

template <int Rank>
MomentsOfBodies<Rank> DeviceQuadrature::moments()
{
    return {basis_, moments_.view(), moments_.size() / (first_.size() * Rank)};
}

template <int Rank, typename Source>
void DeviceQuadrature::climb(Operators all, const Source& source)
{
    using FromLeaves = ClimbFromLeaves<Rank, Source>;
    std::vector<CountedKernel<FromLeaves>> from_leaves;
    for (DeviceQuadrature& one : all)
        if (one.basis_.rank == Rank) {
            const FromLeaves kernel{one.template moments<Rank>(), one.nodes_.view(), one.first_.view(),
                                    source, one.sources_.view()};
            from_leaves.push_back({kernel, one.first_.size() * kernel.blocks_of_body()});
        }
    if (from_leaves.empty())
        return;
    const CudaSpace& space = all[0].space_;
    parallel_for_blocks<FromLeaves::kThreads>(space, "quadrature/leaf_moments", from_leaves,
                                              FromLeaves::kSharedBytes);

    // A block each for as many clusters as it has threads, until one is left.
    using FromLevel = ClimbFromLevel<Rank>;
    for (int level = FromLeaves::kLevels;; level += FromLevel::kLevels) {
        std::vector<CountedKernel<FromLevel>> from_level;
        for (DeviceQuadrature& one : all)
            if (one.basis_.rank == Rank && level_size(one.basis_.leaf_count, level) > 1) {
                const FromLevel kernel{one.template moments<Rank>(), level,
                                       FromLevel::levels_from(level, one.basis_.leaf_count)};
                from_level.push_back({kernel, one.first_.size() * kernel.blocks_of_body()});
            }
        if (from_level.empty())
            return;
        parallel_for_blocks<FromLevel::kThreads>(space, "quadrature/moments", from_level,
                                                 FromLevel::kSharedBytes);
    }
}

template <int Rank, typename Sink>
void DeviceQuadrature::gather_leaves(Operators all, const Sink& sink)
{
    using Gather = GatherLeafByTeam<Rank, Sink>;
    constexpr int kLeavesOfBlock = ClimbFromLeaves<Rank, LoadField>::kLeaves;
    std::vector<CountedKernel<Gather>> kernels;
    for (DeviceQuadrature& one : all)
        if (one.basis_.rank == Rank) {
            const Gather kernel{one.kernel_.packed.view(),
                                one.kernel_.rest.view(),
                                one.sources_.view(),
                                one.moments_.view(),
                                one.nodes_.view(),
                                one.basis_.leaf_count,
                                one.first_.view(),
                                one.basis_.leaf_count > kLeavesOfBlock,
                                sink};
            kernels.push_back({kernel, kernel.teams(Gather::kThreads)});
        }
    if (!kernels.empty())
        parallel_for_teams<Gather::kThreads>(all[0].space_, "quadrature/gather", kernels);
}

} // namespace toile
