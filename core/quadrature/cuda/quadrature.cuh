#pragma once

/// Kernel launches of DeviceQuadrature for any source of right-hand sides and any sink of solutions. Included
/// by .cu files only, like parallel.cuh.

#include <algorithm>

#include "core/compute/cuda/teams.cuh"
#include "core/quadrature/cuda/quadrature.h"

namespace toile {

template <typename Source>
void DeviceQuadrature::begin_solve(Operators all, const Source& source)
{
    upward_pass<rank_of(Extent::Surface)>(all, source);
    upward_pass<rank_of(Extent::Volume)>(all, source);
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
    return {basis_, moments_.view(), moments_.size() / (bodies_ * Rank)};
}

/// Leaves of the largest operator with that rank; 0 if there is none.
template <int Rank>
int DeviceQuadrature::max_leaves(Operators all)
{
    int max_count = 0;
    for (const DeviceQuadrature& one : all)
        if (one.basis_.rank == Rank)
            max_count = std::max(max_count, one.basis_.leaf_count);
    return max_count;
}

template <int Rank, typename Source>
void DeviceQuadrature::upward_pass(Operators all, const Source& source)
{
    const int max_leaves = DeviceQuadrature::max_leaves<Rank>(all);
    if (max_leaves == 0)
        return;
    using FromLeaves = UpwardPassFromLeaves<Rank, Source>;
    const auto from_leaves = [&](int k) -> CountedKernel<FromLeaves> {
        DeviceQuadrature& one = all[k];
        if (one.basis_.rank != Rank)
            return {};
        const FromLeaves kernel{one.template moments<Rank>(), one.slots(), source, one.sources_.view()};
        return {kernel, one.bodies_ * kernel.blocks_of_body()};
    };
    const CudaSpace& space = all[0].space_;
    parallel_for_blocks<FromLeaves::kThreads, FromLeaves>(space, "quadrature/leaf_moments", all.size(),
                                                          from_leaves, FromLeaves::kSharedBytes);

    // One block per as many clusters as it has threads for, until one cluster is left.
    using FromLevel = UpwardPassFromLevel<Rank>;
    for (int level = FromLeaves::kLevels; level_size(max_leaves, level) > 1; level += FromLevel::kLevels) {
        const auto from_level = [&](int k) -> CountedKernel<FromLevel> {
            DeviceQuadrature& one = all[k];
            if (one.basis_.rank != Rank || level_size(one.basis_.leaf_count, level) == 1)
                return {};
            const FromLevel kernel{one.template moments<Rank>(), level,
                                   upward_levels(one.basis_.leaf_count, level, FromLevel::kLevels)};
            return {kernel, one.bodies_ * kernel.blocks_of_body()};
        };
        parallel_for_blocks<FromLevel::kThreads, FromLevel>(space, "quadrature/moments", all.size(),
                                                            from_level, FromLevel::kSharedBytes);
    }
}

template <int Rank, typename Sink>
void DeviceQuadrature::gather_leaves(Operators all, const Sink& sink)
{
    if (max_leaves<Rank>(all) == 0)
        return;
    using Gather = GatherLeafByTeam<Rank, Sink>;
    constexpr int kLeavesOfBlock = UpwardPassFromLeaves<Rank, LoadField>::kLeaves;
    const auto gather = [&](int k) -> CountedKernel<Gather> {
        DeviceQuadrature& one = all[k];
        if (one.basis_.rank != Rank)
            return {};
        const Gather kernel{one.kernel_.packed.view(),
                            one.kernel_.rest.view(),
                            one.sources_.view(),
                            one.moments_.view(),
                            one.slots(),
                            one.basis_.leaf_count,
                            one.basis_.leaf_count > kLeavesOfBlock,
                            sink};
        return {kernel, kernel.teams(Gather::kThreads)};
    };
    parallel_for_teams<Gather::kThreads, Gather>(all[0].space_, "quadrature/gather", all.size(), gather);
}

} // namespace toile
