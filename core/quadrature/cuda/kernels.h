#pragma once

#include "core/compute/team.h"
#include "core/quadrature/clusters/moments.h"
#include "core/quadrature/packed_lists.h"

namespace toile {

/// Moments of all bodies, as the first pass writes them.
template <int Rank>
struct MomentsOfBodies {
    BasisView<float> basis;
    View<PaddedVec3> moments; ///< [bodies * clusters * Rank]
    int clusters;             ///< of one body

    /// Moments of one cluster of a body, function after function.
    TOILE_HD PaddedVec3* of(int body, int level, int c) const
    {
        return &moments[(body * clusters + basis.first_of_level[level] + c) * Rank];
    }

    /// Number of clusters of a level from c on, at most `max_nodes`.
    TOILE_HD int nodes_of(int level, int c, int max_nodes) const
    {
        const int left = level_size(basis.leaf_count, level) - c;
        return left < 0 ? 0 : left < max_nodes ? left : max_nodes;
    }

    /// Transfer coefficients of one thread for the upward pass. Loaded before the pass begins; loads at each
    /// level would stall it.
    template <int Levels>
    struct Transfers {
        float of[Levels][2 * Rank];
    };
    template <int Levels>
    TOILE_HD Transfers<Levels> transfers(int thread, int level, int first, int count, int levels) const
    {
        const int c = thread / Rank, r = thread % Rank;
        Transfers<Levels> local = {};
        for (int k = 0; k < Levels; ++k)
            for (int child = 0; child < 2; ++child)
                if (k < levels && 2 * c + child < level_size(count, k)) {
                    const int id = basis.first_of_level[level + k] + (first >> k) + 2 * c + child;
                    for (int s = 0; s < Rank; ++s)
                        local.of[k][child * Rank + s] = basis.transfers[(id * Rank + s) * Rank + r];
                }
        return local;
    }

    /// Computes moments over `levels` levels, from clusters [first, first + count) of `level` to their common
    /// ancestors. The moments of `level` are in block.memory [count * Rank]. Children come before parents,
    /// with one thread per function of a cluster, so at most 2 kThreads / Rank clusters.
    template <int Levels, typename Block>
    TOILE_HD void upward_pass(const Block& block, int body, int level, int first, int count, int levels,
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

/// Slots of equal bodies: those of the leaves first, then nodes outside all leaves.
struct SlotsOfBodies {
    View<const int> rows; ///< [bodies * count] node of every slot among those of all bodies, -1 where padded
    int count;            ///< of one body

    TOILE_HD int bodies() const { return rows.size() / count; }
    TOILE_HD int row(int body, int slot) const { return rows[body * count + slot]; }
};

/// Source and sink that are arrays (other sources and sinks: DeviceQuadrature::begin_solve).
struct LoadField {
    View<const Vec3> b; ///< [nodes of all bodies]

    struct Prologue {};
    TOILE_HD Prologue prologue(int) const { return {}; }
    TOILE_HD PaddedVec3 operator()(int v, const Prologue&) const { return padded(b[v]); }
};
struct StoreField {
    View<Vec3> x; ///< [nodes of all bodies] out

    TOILE_HD bool is_wanted() const { return true; }
    TOILE_HD void operator()(int v, const PaddedVec3& value) const { x[v] = unpadded(value); }
};

/// Levels that one block ascends from `level`: until one cluster is left, at most `max_levels`.
TOILE_HD inline int upward_levels(int leaf_count, int level, int max_levels)
{
    int levels = 0;
    while (levels < max_levels && level_size(leaf_count, level + levels) > 1)
        ++levels;
    return levels;
}

/// First pass, from the leaves. A block sorts the right-hand side of kLeaves leaves into slots, zero for
/// padding. It then computes the moments of the leaves and of their ancestors up to the common one. One
/// thread per slot. Slots after those of the leaves hold nodes outside all leaves, whose right-hand side is
/// stored too.
template <int Rank, typename Source>
struct UpwardPassFromLeaves {
    static constexpr int kLevels = 5, kLeaves = 1 << kLevels;
    static constexpr int kThreads = kLeaves * ClusterTree::kLeaf;
    static constexpr std::size_t kSharedBytes = (2 * kLeaves + kLevels) * Rank * sizeof(PaddedVec3);
    static_assert(Rank <= ClusterTree::kLeaf && kLeaves / 2 * Rank <= kThreads);

    MomentsOfBodies<Rank> moments;
    SlotsOfBodies slots;
    Source source;
    View<PaddedVec3> sources; ///< [bodies * slots] out

    TOILE_HD int blocks_of_body() const { return (slots.count + kThreads - 1) / kThreads; }

    /// Data that no launch changes: leaves of a block, a thread's slot and node, its weights. Plus the
    /// source's prologue.
    struct Prologue {
        int body, first_leaf, leaves, slot;
        bool exists, is_of_leaf;
        int node; ///< among those of all bodies, -1 where padded
        float weights[Rank];
        typename MomentsOfBodies<Rank>::template Transfers<kLevels> transfers;
        typename Source::Prologue source;
    };
    template <typename Block>
    TOILE_HD Prologue prologue(int k, const Block& block) const
    {
        Prologue local;
        local.body = k / blocks_of_body();
        local.first_leaf = k % blocks_of_body() * kLeaves;
        local.leaves = moments.nodes_of(0, local.first_leaf, kLeaves);
        local.slot = local.first_leaf * ClusterTree::kLeaf + block.thread;
        local.exists = local.slot < slots.count;
        local.is_of_leaf = block.thread < local.leaves * ClusterTree::kLeaf;
        local.node = local.exists ? slots.row(local.body, local.slot) : -1;
        if (local.node >= 0)
            local.source = source.prologue(local.node);
        for (int r = 0; r < Rank; ++r)
            local.weights[r] = local.is_of_leaf ? moments.basis.leaves[local.slot * Rank + r] : 0.0F;
        local.transfers =
            moments.template transfers<kLevels>(block.thread, 0, local.first_leaf, local.leaves, levels());
        return local;
    }

    template <typename Block>
    TOILE_HD void operator()(int k, const Block& block) const
    {
        (*this)(k, block, prologue(k, block));
    }
    template <typename Block>
    TOILE_HD void operator()(int, const Block& block, const Prologue& local) const
    {
        const PaddedVec3 at_node = local.node >= 0 ? source(local.node, local.source) : PaddedVec3(0.0F);
        if (local.exists)
            sources[local.body * slots.count + local.slot] = at_node;
        gather_leaf(block, local, at_node);
        block.wait();
        moments.template upward_pass<kLevels>(block, local.body, 0, local.first_leaf, local.leaves, levels(),
                                              local.transfers);
    }

    TOILE_HD int levels() const { return upward_levels(moments.basis.leaf_count, 0, kLevels); }

private:
    template <typename Block>
    TOILE_HD void gather_leaf(const Block& block, const Prologue& local, const PaddedVec3& at_node) const
    {
        const TeamOf<ClusterTree::kLeaf> team{block.thread % ClusterTree::kLeaf};
        const int leaf = block.thread / ClusterTree::kLeaf;
        auto* const of_leaves = static_cast<PaddedVec3*>(block.memory);
        for (int r = 0; r < Rank; ++r) {
            PaddedVec3 moment = local.weights[r] * at_node;
            for (int a = 0; a < 3; ++a)
                moment.value[a] = team.sum(1, moment[a]);
            if (local.is_of_leaf && team.thread == r) {
                of_leaves[leaf * Rank + r] = moment;
                moments.of(local.body, 0, local.first_leaf + leaf)[r] = moment;
            }
        }
    }
};

/// First pass, higher levels: a block starts from up to kNodes clusters of a level.
template <int Rank>
struct UpwardPassFromLevel {
    static constexpr int kLevels = 8, kNodes = 1 << kLevels;
    static constexpr int kThreads = kNodes / 2 * Rank; ///< one per function of a parent
    /// Every level has half the clusters of the one below, rounded up.
    static constexpr std::size_t kSharedBytes = (2 * kNodes + kLevels) * Rank * sizeof(PaddedVec3);

    MomentsOfBodies<Rank> moments;
    int level;
    int levels; ///< of the upward pass; at most kLevels

    TOILE_HD int blocks_of_body() const { return level_size(moments.basis.leaf_count, level + levels); }

    /// Data that no launch changes.
    using Prologue = typename MomentsOfBodies<Rank>::template Transfers<kLevels>;
    template <typename Block>
    TOILE_HD Prologue prologue(int k, const Block& block) const
    {
        const int first = first_of(k);
        return moments.template transfers<kLevels>(block.thread, level, first, count_from(first), levels);
    }

    template <typename Block>
    TOILE_HD void operator()(int k, const Block& block) const
    {
        (*this)(k, block, prologue(k, block));
    }
    template <typename Block>
    TOILE_HD void operator()(int k, const Block& block, const Prologue& transfers) const
    {
        const int body = k / blocks_of_body(), first = first_of(k), count = count_from(first);
        auto* const lowest = static_cast<PaddedVec3*>(block.memory);
        for (int item = block.thread; item < count * Rank; item += Block::kThreads)
            lowest[item] = moments.of(body, level, first)[item];
        block.wait();
        moments.template upward_pass<kLevels>(block, body, level, first, count, levels, transfers);
    }

private:
    TOILE_HD int first_of(int k) const { return k % blocks_of_body() << levels; }
    TOILE_HD int count_from(int first) const { return moments.nodes_of(level, first, 1 << levels); }
};

/// Second pass with one team per leaf: its threads divide the lists, and each sums all targets. Teams after
/// those of the leaves set x = b at nodes outside the table, which are fixed.
template <int Rank, typename Sink>
struct GatherLeafByTeam {
    /// Of a team. On surfaces with 32 the reduction doubles the time, and 8 are too few; lists of volumes are
    /// longer.
    static constexpr int kThreads = Rank == rank_of(Extent::Surface) ? 16 : 32;

    PackedView packed;
    KernelView rest;                ///< entries that are not packed
    View<const PaddedVec3> sources; ///< [bodies * slots]
    View<const PaddedVec3> moments; ///< [bodies * clusters * rank]
    SlotsOfBodies slots;
    int leaves;            ///< of one body
    bool has_level_passes; ///< sources are older than the previous launch, a pass between levels
    Sink sink;

    TOILE_HD int leaves_of_all() const { return slots.bodies() * leaves; }
    TOILE_HD int teams(int team_size) const
    {
        return leaves_of_all() + (slots.bodies() * others() + team_size - 1) / team_size;
    }

    /// Data that no launch changes: the far lists and the target that the thread writes. With
    /// has_level_passes also the near field and the sink's is_wanted(), whose inputs are older than the
    /// previous launch.
    struct Prologue {
        PackedSum<Rank> near;
        ListRows far_list;
        KernelView::Entries rest_far;
        int target; ///< among the nodes of all bodies, -1 for none
        bool is_wanted;
    };
    template <typename Team>
    TOILE_HD Prologue prologue(int k, const Team& team, bool is_in_range) const
    {
        Prologue local{{}, {}, {}, -1, !has_level_passes || sink.is_wanted()};
        if (k >= leaves_of_all())
            return local;
        const int leaf = leaf_of(k);
        local.far_list = local.near.far_rows(packed, leaf, team.thread, Team::kThreads);
        local.rest_far = rest.far_of(leaf);
        local.target = is_in_range ? target_of(k, team) : -1;
        if (has_level_passes)
            add_near(k, team, local.near);
        return local;
    }

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_in_range) const
    {
        (*this)(k, team, is_in_range, prologue(k, team, is_in_range));
    }
    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_in_range, const Prologue& local) const
    {
        if (!local.is_wanted)
            return;
        PackedSum<Rank> all = local.near;
        if (k < leaves_of_all()) {
            if (!has_level_passes)
                add_near(k, team, all);
            add_far(k, team, local, all);
        }
        const auto sums = team.template reduce_scatter<KernelView::kTargets>(numbers_of(all));
        if (local.target >= 0)
            sink(local.target, PaddedVec3{sums[0], sums[1], sums[2], 0.0F});
        if (k >= leaves_of_all() && is_in_range)
            pass_other((k - leaves_of_all()) * Team::kThreads + team.thread);
    }

private:
    TOILE_HD int others() const { return slots.count - leaves * ClusterTree::kLeaf; }
    TOILE_HD int leaf_of(int k) const { return k % leaves; }

    /// Part of an array of all bodies that belongs to team k's body.
    TOILE_HD View<const PaddedVec3> of_body(View<const PaddedVec3> all, int k) const
    {
        const int count = all.size() / slots.bodies();
        return all.subview(k / leaves * count, count);
    }

    /// Target whose sum a thread writes, among the nodes of all bodies; -1 for none.
    template <typename Team>
    TOILE_HD int target_of(int k, const Team& team) const
    {
        constexpr int kOfTarget = Team::kThreads / KernelView::kTargets; ///< threads that hold its sum
        if (team.thread % kOfTarget != 0)
            return -1;
        return slots.row(k / leaves, leaf_of(k) * ClusterTree::kLeaf + team.thread / kOfTarget);
    }

    template <typename Team>
    TOILE_HD void add_near(int k, const Team& team, PackedSum<Rank>& all) const
    {
        const auto body_sources = of_body(sources, k);
        const KernelView::Entries rest_near = rest.near_of(leaf_of(k));
        all.add_near(packed, body_sources, all.near_rows(packed, leaf_of(k), team.thread, Team::kThreads));
        all.sum.add_near(rest, body_sources, rest_near, {0, team.thread, Team::kThreads});
    }

    template <typename Team>
    TOILE_HD void add_far(int k, const Team& team, const Prologue& local, PackedSum<Rank>& all) const
    {
        const auto body_moments = of_body(moments, k);
        all.add_far(packed, body_moments, local.far_list);
        all.sum.add_far(rest, body_moments, local.rest_far, {0, team.thread, Team::kThreads});
    }

    /// Sums as numbers, target after target, x, y and z of each.
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
        if (k >= slots.bodies() * others())
            return;
        const int body = k / others(), slot = leaves * ClusterTree::kLeaf + k % others();
        sink(slots.row(body, slot), sources[body * slots.count + slot]);
    }
};

} // namespace toile
