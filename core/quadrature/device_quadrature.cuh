#pragma once

/// The kernels of DeviceQuadrature around any source of right-hand sides and any sink of solutions. Included
/// by .cu files, as parallel.cuh.

#include "core/backend/cuda/teams.cuh"
#include "core/quadrature/device_quadrature.h"

namespace toile {

template <typename Source>
void DeviceQuadrature::begin_solve(const Source& source)
{
    if (basis_.rank == rank_of(Extent::Surface))
        climb<rank_of(Extent::Surface)>(source);
    else
        climb<rank_of(Extent::Volume)>(source);
}

template <int Rank, typename Source>
void DeviceQuadrature::climb(const Source& source)
{
    using FromLeaves = ClimbFromLeaves<Rank, Source>;
    using FromLevel = ClimbFromLevel<Rank>;
    const int bodies = first_.size();
    const MomentsOfBodies<Rank> moments{basis_, moments_.view(), moments_.size() / (bodies * Rank)};
    const FromLeaves from_leaves{moments, nodes_.view(), first_.view(), source, sources_.view()};
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

template <typename Sink>
void DeviceQuadrature::end_solve(const Sink& sink)
{
    if (basis_.rank == rank_of(Extent::Surface))
        gather_leaves<rank_of(Extent::Surface)>(sink);
    else
        gather_leaves<rank_of(Extent::Volume)>(sink);
}

template <int Rank, typename Sink>
void DeviceQuadrature::gather_leaves(const Sink& sink)
{
    constexpr int kLeavesOfBlock = ClimbFromLeaves<Rank, LoadField>::kLeaves;
    const GatherLeafByTeam<Rank, Sink> leaves{kernel_.packed.view(),
                                              kernel_.rest.view(),
                                              sources_.view(),
                                              moments_.view(),
                                              nodes_.view(),
                                              basis_.leaf_count,
                                              first_.view(),
                                              basis_.leaf_count > kLeavesOfBlock,
                                              sink};
    constexpr int kTeam = GatherLeafByTeam<Rank, Sink>::kThreads;
    parallel_for_teams<kTeam>(space_, "quadrature/gather", leaves.teams(kTeam), leaves);
}

} // namespace toile
