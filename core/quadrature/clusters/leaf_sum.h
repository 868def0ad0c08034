#pragma once

#include "core/compute/lanes.h"
#include "core/compute/unroll.h"
#include "core/quadrature/clusters/cluster_tree.h"

namespace toile {

/// View of a KernelTable for kernels, on the CPU or on a GPU.
struct KernelView {
    static constexpr int kTargets = ClusterTree::kLeaf;

    /// Entries [begin, end) of a list.
    struct Entries {
        int begin, end;
    };

    View<const int> near_first;     ///< [leaves + 1] into near_leaf
    View<const int> near_leaf;      ///< source leaves
    View<const float> near_weights; ///< [near_leaf][source node][kTargets] [m/N]
    View<const int> far_first;      ///< [leaves + 1] into far_cluster
    View<const int> far_cluster;    ///< source clusters
    View<const float> far_weights;  ///< [far_cluster][rank][kTargets] [m/N]

    TOILE_HD Entries near_of(int leaf) const { return {near_first[leaf], near_first[leaf + 1]}; }
    TOILE_HD Entries far_of(int leaf) const { return {far_first[leaf], far_first[leaf + 1]}; }
};

/// Part of a leaf's sum: these targets, and every `groups`-th entry of the lists from `group` on.
struct LeafPart {
    int first_target = 0;
    int group = 0;
    int groups = 1;
};

/// Second pass of quadrature for the targets of one leaf: q_i = sum_near G_ij r_j + sum_far w_iC . m_C
///
/// Targets: some of the eight, side by side: FloatLanes in the CPU's vector registers, Floats<2> in a thread
/// of a GPU. Rank: the table's, a template parameter so that the compiler unrolls the inner loop.
template <int Rank, typename Targets>
struct LeafSum {
    Targets axis[3] = {Targets(0.0F), Targets(0.0F), Targets(0.0F)}; ///< x, y and z of the targets

    /// @param sources  [slots] r
    template <typename Vector>
    TOILE_HD void add_near(const KernelView& table, View<const Vector> sources, KernelView::Entries entries,
                           const LeafPart& part)
    {
        LeafSum sum = *this; // in registers: in memory it might alias the weights
        sum.template add_list<ClusterTree::kLeaf>(table.near_weights, table.near_leaf, sources, entries,
                                                  part);
        *this = sum;
    }

    /// @param moments  [Rank * clusters] m
    template <typename Vector>
    TOILE_HD void add_far(const KernelView& table, View<const Vector> moments, KernelView::Entries entries,
                          const LeafPart& part)
    {
        LeafSum sum = *this;
        sum.template add_list<Rank>(table.far_weights, table.far_cluster, moments, entries, part);
        *this = sum;
    }

private:
    template <int Count, typename Vector>
    TOILE_HD void add_list(View<const float> weights, View<const int> source, View<const Vector> values,
                           KernelView::Entries entries, const LeafPart& part)
    {
        TOILE_UNROLL(1) // on a GPU few entries remain here; they must not take registers from the packed ones
        for (int e = entries.begin + part.group; e < entries.end; e += part.groups)
            add_entry<Count>(weights, e, part.first_target, &values[source[e] * Count]);
    }

    /// Weights [Count][kTargets] times values [Count].
    template <int Count, typename Vector>
    TOILE_HD void add_entry(View<const float> weights, int entry, int first_target, const Vector* values)
    {
        const float* const first =
            weights.data() + std::size_t(entry) * Count * KernelView::kTargets + first_target;
        TOILE_UNROLL(1)
        for (int k = 0; k < Count; ++k) {
            const Targets weight = load_as<Targets>(first + k * KernelView::kTargets);
            const Vector value = values[k];
            for (int a = 0; a < 3; ++a)
                axis[a] += weight * value[a];
        }
    }
};

} // namespace toile
