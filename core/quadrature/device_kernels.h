#pragma once

#include "core/backend/cuda/team.h"
#include "core/quadrature/moments.h"
#include "core/quadrature/packed_lists.h"

namespace toile {

/// Moments of all bodies as the first pass writes them.
template <int Rank>
struct MomentsOfBodies {
    BasisView<float> basis;
    View<PaddedVec3> moments; ///< [bodies * clusters * Rank]
    int clusters;             ///< of one body

    /// Of a cluster of a body, function after function.
    TOILE_HD PaddedVec3* of(int body, int level, int c) const
    {
        return &moments[(body * clusters + basis.first_of_level[level] + c) * Rank];
    }

    /// Clusters of a level from c on, at most so many.
    TOILE_HD int nodes_of(int level, int c, int most) const
    {
        const int left = level_size(basis.leaf_count, level) - c;
        return left < 0 ? 0 : left < most ? left : most;
    }

    /// What a thread takes of the basis where its block climbs: loaded before that begins, since level by
    /// level it would be waited for.
    template <int Levels>
    struct Transfers {
        float of[Levels][2 * Rank];
    };
    template <int Levels>
    TOILE_HD Transfers<Levels> transfers(int thread, int level, int first, int count, int levels) const
    {
        const int c = thread / Rank, r = thread % Rank;
        Transfers<Levels> own = {};
        for (int k = 0; k < Levels; ++k)
            for (int child = 0; child < 2; ++child)
                if (k < levels && 2 * c + child < level_size(count, k)) {
                    const int id = basis.first_of_level[level + k] + (first >> k) + 2 * c + child;
                    for (int s = 0; s < Rank; ++s)
                        own.of[k][child * Rank + s] = basis.transfers[(id * Rank + s) * Rank + r];
                }
        return own;
    }

    /// Climbs `levels` levels from clusters [first, first + count) of `level`, whose moments are in
    /// block.memory [count * Rank], to their common ancestors: children before parents, a thread for
    /// every function of a cluster, so at most 2 kThreads / Rank clusters.
    template <int Levels, typename Block>
    TOILE_HD void climb(const Block& block, int body, int level, int first, int count, int levels,
                        const Transfers<Levels>& transfers) const
    {
        const int c = block.thread / Rank, r = block.thread % Rank;
        auto* below = static_cast<PaddedVec3*>(block.memory);
        for (int k = 0; k < Levels; ++k) {
            if (k == levels)
                return;
            const int children = level_size(count, k), parents = level_size(count, k + 1);
            PaddedVec3* const above = below + children * Rank;
            if (c < parents) {
                PaddedVec3 sum(0.0F);
                for (int s = 0; s < 2 * Rank; ++s)
                    if (2 * c + s / Rank < children)
                        sum += transfers.of[k][s] * below[2 * c * Rank + s];
                above[c * Rank + r] = sum;
                of(body, level + k + 1, (first >> (k + 1)) + c)[r] = sum;
            }
            block.wait();
            below = above;
        }
    }
};

/// A right-hand side, and a solution, that are arrays (what else they may be: DeviceQuadrature::begin_solve).
struct LoadField {
    View<const Vec3> b; ///< [nodes of all]

    struct Early {};
    TOILE_HD Early early(int) const { return {}; }
    TOILE_HD PaddedVec3 operator()(int v, const Early&) const { return padded(b[v]); }
};
struct StoreField {
    View<Vec3> x; ///< [nodes of all] out

    TOILE_HD bool is_wanted() const { return true; }
    TOILE_HD void operator()(int v, const PaddedVec3& value) const { x[v] = unpadded(value); }
};

/// Levels that a block climbs from this one: until one cluster is left, or so many at most.
TOILE_HD inline int levels_to_climb(int leaf_count, int level, int most)
{
    int levels = 0;
    while (levels < most && level_size(leaf_count, level + levels) > 1)
        ++levels;
    return levels;
}

/// First pass from the leaves up: a block sorts the right-hand side of kLeaves leaves into slots, zero where
/// padded, takes the moments of the leaves and climbs to their common ancestor. A thread for every slot.
/// Slots after those of the leaves have nodes that are in none, whose right-hand side is kept too.
template <int Rank, typename Source>
struct ClimbFromLeaves {
    static constexpr int kLevels = 5, kLeaves = 1 << kLevels;
    static constexpr int kThreads = kLeaves * ClusterTree::kLeaf;
    static constexpr std::size_t kSharedBytes = (2 * kLeaves + kLevels) * Rank * sizeof(PaddedVec3);
    static_assert(Rank <= ClusterTree::kLeaf && kLeaves / 2 * Rank <= kThreads);

    MomentsOfBodies<Rank> moments;
    View<const int> nodes; ///< [slots] of one body, -1 where padded
    View<const int> first; ///< [bodies] where a body's nodes begin among those of all
    Source source;
    View<PaddedVec3> sources; ///< [bodies * slots] out

    TOILE_HD int blocks_of_body() const { return (nodes.size() + kThreads - 1) / kThreads; }

    /// What no launch changes: leaves of a block, a thread's slot and node, its weights. And what the source
    /// finds early.
    struct Early {
        int body, first_leaf, leaves, slot;
        bool exists, is_of_leaf;
        int node; ///< among those of all bodies, -1 where padded
        float weights[Rank];
        typename MomentsOfBodies<Rank>::template Transfers<kLevels> transfers;
        typename Source::Early source;
    };
    template <typename Block>
    TOILE_HD Early early(int k, const Block& block) const
    {
        Early own;
        own.body = k / blocks_of_body();
        own.first_leaf = k % blocks_of_body() * kLeaves;
        own.leaves = moments.nodes_of(0, own.first_leaf, kLeaves);
        own.slot = own.first_leaf * ClusterTree::kLeaf + block.thread;
        own.exists = own.slot < nodes.size();
        own.is_of_leaf = block.thread < own.leaves * ClusterTree::kLeaf;
        const int v = own.exists ? nodes[own.slot] : -1;
        own.node = v >= 0 ? first[own.body] + v : -1;
        if (own.node >= 0)
            own.source = source.early(own.node);
        for (int r = 0; r < Rank; ++r)
            own.weights[r] = own.is_of_leaf ? moments.basis.leaves[own.slot * Rank + r] : 0.0F;
        own.transfers =
            moments.template transfers<kLevels>(block.thread, 0, own.first_leaf, own.leaves, levels());
        return own;
    }

    template <typename Block>
    TOILE_HD void operator()(int k, const Block& block) const
    {
        (*this)(k, block, early(k, block));
    }
    template <typename Block>
    TOILE_HD void operator()(int, const Block& block, const Early& own) const
    {
        const PaddedVec3 at_node = own.node >= 0 ? source(own.node, own.source) : PaddedVec3(0.0F);
        if (own.exists)
            sources[own.body * nodes.size() + own.slot] = at_node;
        gather_leaf(block, own, at_node);
        block.wait();
        moments.template climb<kLevels>(block, own.body, 0, own.first_leaf, own.leaves, levels(),
                                        own.transfers);
    }

    TOILE_HD int levels() const { return levels_to_climb(moments.basis.leaf_count, 0, kLevels); }

private:
    template <typename Block>
    TOILE_HD void gather_leaf(const Block& block, const Early& own, const PaddedVec3& at_node) const
    {
        const TeamOf<ClusterTree::kLeaf> team{block.thread % ClusterTree::kLeaf};
        const int leaf = block.thread / ClusterTree::kLeaf;
        auto* const of_leaves = static_cast<PaddedVec3*>(block.memory);
        for (int r = 0; r < Rank; ++r) {
            PaddedVec3 moment = own.weights[r] * at_node;
            for (int a = 0; a < 3; ++a)
                moment.value[a] = team.sum(1, moment[a]);
            if (own.is_of_leaf && team.thread == r) {
                of_leaves[leaf * Rank + r] = moment;
                moments.of(own.body, 0, own.first_leaf + leaf)[r] = moment;
            }
        }
    }
};

/// First pass further up: a block climbs from up to kNodes clusters of a level.
template <int Rank>
struct ClimbFromLevel {
    static constexpr int kLevels = 8, kNodes = 1 << kLevels;
    static constexpr int kThreads = kNodes / 2 * Rank; ///< one for every function of a parent
    /// Every level has half the clusters of the one below, rounded up.
    static constexpr std::size_t kSharedBytes = (2 * kNodes + kLevels) * Rank * sizeof(PaddedVec3);

    MomentsOfBodies<Rank> moments;
    int level;
    int levels; ///< to climb: at most kLevels

    TOILE_HD int blocks_of_body() const { return level_size(moments.basis.leaf_count, level + levels); }

    /// What no launch changes.
    using Early = typename MomentsOfBodies<Rank>::template Transfers<kLevels>;
    template <typename Block>
    TOILE_HD Early early(int k, const Block& block) const
    {
        const int first = first_of(k);
        return moments.template transfers<kLevels>(block.thread, level, first, count_from(first), levels);
    }

    template <typename Block>
    TOILE_HD void operator()(int k, const Block& block) const
    {
        (*this)(k, block, early(k, block));
    }
    template <typename Block>
    TOILE_HD void operator()(int k, const Block& block, const Early& transfers) const
    {
        const int body = k / blocks_of_body(), first = first_of(k), count = count_from(first);
        auto* const lowest = static_cast<PaddedVec3*>(block.memory);
        for (int item = block.thread; item < count * Rank; item += Block::kThreads)
            lowest[item] = moments.of(body, level, first)[item];
        block.wait();
        moments.template climb<kLevels>(block, body, level, first, count, levels, transfers);
    }

private:
    TOILE_HD int first_of(int k) const { return k % blocks_of_body() << levels; }
    TOILE_HD int count_from(int first) const { return moments.nodes_of(level, first, 1 << levels); }
};

/// Second pass by a team per leaf: its threads share the lists, and have all targets each. Teams after those
/// of the leaves pass x = b where the table knows nothing: at fixed nodes.
template <int Rank, typename Sink>
struct GatherLeafByTeam {
    static constexpr int kThreads = 16; ///< of a team: with 32 adding up takes as long again, 8 are too few

    PackedView packed;
    KernelView rest;                ///< entries that are not packed
    View<const PaddedVec3> sources; ///< [bodies * slots]
    View<const PaddedVec3> moments; ///< [bodies * clusters * rank]
    View<const int> nodes;          ///< [slots] first those of leaves
    int leaves;                     ///< of one body
    View<const int> first;          ///< [bodies] where a body's nodes begin among those of all
    bool climbs_apart; ///< sources are older than the launch before, which still climbs from level to level
    Sink sink;

    TOILE_HD int leaves_of_all() const { return first.size() * leaves; }
    TOILE_HD int teams(int team_size) const
    {
        return leaves_of_all() + (first.size() * others() + team_size - 1) / team_size;
    }

    /// What no launch changes: where the far lists are, whose sum the thread writes. And the near field, and
    /// whether there is to be any, where what tells it is older.
    struct Early {
        PackedSum<Rank> near;
        ListRows far_list;
        KernelView::Entries rest_far;
        int target; ///< among the nodes of all bodies, -1 for none
        bool is_wanted;
    };
    template <typename Team>
    TOILE_HD Early early(int k, const Team& team, bool is_own) const
    {
        Early own{{}, {}, {}, -1, !climbs_apart || sink.is_wanted()};
        if (k >= leaves_of_all())
            return own;
        const int leaf = leaf_of(k);
        own.far_list = own.near.far_rows(packed, leaf, team.thread, Team::kThreads);
        own.rest_far = rest.far_of(leaf);
        own.target = is_own ? target_of(k, team) : -1;
        if (climbs_apart)
            add_near(k, team, own.near);
        return own;
    }

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_own) const
    {
        (*this)(k, team, is_own, early(k, team, is_own));
    }
    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_own, const Early& own) const
    {
        if (!own.is_wanted)
            return;
        PackedSum<Rank> all = own.near;
        if (k < leaves_of_all()) {
            if (!climbs_apart)
                add_near(k, team, all);
            add_far(k, team, own, all);
        }
        const auto sums = team.template sum_shares<KernelView::kTargets>(numbers_of(all));
        if (own.target >= 0)
            sink(own.target, PaddedVec3{sums[0], sums[1], sums[2], 0.0F});
        if (k >= leaves_of_all() && is_own)
            pass_other((k - leaves_of_all()) * Team::kThreads + team.thread);
    }

private:
    TOILE_HD int others() const { return nodes.size() - leaves * ClusterTree::kLeaf; }
    TOILE_HD int leaf_of(int k) const { return k % leaves; }

    /// The part of an array of all bodies that team k's has.
    TOILE_HD View<const PaddedVec3> of_body(View<const PaddedVec3> all, int k) const
    {
        const int count = all.size() / first.size();
        return all.subview(k / leaves * count, count);
    }

    /// Whose sum a thread writes, among the nodes of all bodies; -1 for none.
    template <typename Team>
    TOILE_HD int target_of(int k, const Team& team) const
    {
        constexpr int kOfTarget = Team::kThreads / KernelView::kTargets; ///< threads that have its sum
        if (team.thread % kOfTarget != 0)
            return -1;
        const int v = nodes[leaf_of(k) * ClusterTree::kLeaf + team.thread / kOfTarget];
        return v >= 0 ? first[k / leaves] + v : -1;
    }

    template <typename Team>
    TOILE_HD void add_near(int k, const Team& team, PackedSum<Rank>& all) const
    {
        const auto own_sources = of_body(sources, k);
        const KernelView::Entries rest_near = rest.near_of(leaf_of(k));
        all.add_near(packed, own_sources, all.near_rows(packed, leaf_of(k), team.thread, Team::kThreads));
        all.sum.add_near(rest, own_sources, rest_near, {0, team.thread, Team::kThreads});
    }

    template <typename Team>
    TOILE_HD void add_far(int k, const Team& team, const Early& own, PackedSum<Rank>& all) const
    {
        const auto own_moments = of_body(moments, k);
        all.add_far(packed, own_moments, own.far_list);
        all.sum.add_far(rest, own_moments, own.rest_far, {0, team.thread, Team::kThreads});
    }

    /// Axis by axis, target by target.
    TOILE_HD static std::array<float, 3 * KernelView::kTargets> numbers_of(const PackedSum<Rank>& all)
    {
        std::array<float, 3 * KernelView::kTargets> numbers;
        for (int a = 0; a < 3; ++a) {
            const auto total = all.total(a);
            for (int t = 0; t < KernelView::kTargets; ++t)
                numbers[3 * t + a] = total[t];
        }
        return numbers;
    }

    TOILE_HD void pass_other(int k) const
    {
        if (k >= first.size() * others())
            return;
        const int body = k / others(), slot = leaves * ClusterTree::kLeaf + k % others();
        sink(first[body] + nodes[slot], sources[body * nodes.size() + slot]);
    }
};

} // namespace toile
