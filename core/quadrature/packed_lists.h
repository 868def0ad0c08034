#pragma once

#include <cstdint>

#include "core/compute/bits.h"
#include "core/quadrature/clusters/leaf_sum.h"

namespace toile {

/// Lists of a KernelTable with one byte per weight,
///
///   weight = base + scale (byte - 128)
///
/// Entries towards a leaf have one base for all weights; entries towards a cluster have one base per
/// function. Each entry has one scale. The base, in single precision, holds what neighbouring kernel values
/// have in common: by far their largest part if a body is free or stiff.
struct PackedView {
    static constexpr int kWords = KernelView::kTargets / 4; ///< four-byte words per row of targets

    View<const int> near_first;           ///< [leaves + 1] into near_leaf
    View<const int> near_leaf;            ///< source leaves
    View<const std::uint32_t> near_codes; ///< [near_leaf][source node][kWords]
    View<const float> near_scales;        ///< [near_leaf][2] base and scale [m/N]
    View<const int> far_first;            ///< [leaves + 1] into far_cluster
    View<const int> far_cluster;          ///< source clusters
    View<const std::uint32_t> far_codes;  ///< [far_cluster][rank][kWords]
    View<const float> far_scales;         ///< [far_cluster][rank + 1] bases of the functions, scale [m/N]
};

/// Numbers that a thread loads with one instruction.
template <typename Number, int Count>
struct alignas(sizeof(Number) * (Count % 4 == 0   ? 4
                                 : Count % 2 == 0 ? 2
                                                  : 1)) LoadedNumbers {
    Number number[Count];

    /// @param numbers  with the alignment of LoadedNumbers
    TOILE_HD static LoadedNumbers from(const Number* numbers)
    {
        return *reinterpret_cast<const LoadedNumbers*>(numbers);
    }
};

/// Rows of a leaf's list for one thread: source nodes, or functions of clusters, next, next + step and so on.
struct ListRows {
    int next = 0;
    int end = 0;
    int step = 1;
};

/// LeafSum over packed lists: all targets, from every `step`-th source node and function of a cluster.
///
/// A thread processes one row at a time and its neighbour the next one, so their loads are adjacent. Threads
/// that process whole entries need three times as many loads, from scattered addresses. A few rows are loaded
/// together before any is used, so that loads do not wait for each other.
template <int Rank>
struct PackedSum {
    using Targets = Floats<KernelView::kTargets>;

    /// Sum without the contribution of the bases; unpacked entries may be added to it.
    LeafSum<Rank, Targets> sum;

    /// Rows of a leaf for thread `thread` of `threads`.
    TOILE_HD static ListRows near_rows(const PackedView& table, int leaf, int thread, int threads)
    {
        return {table.near_first[leaf] * kNodes + thread, table.near_first[leaf + 1] * kNodes, threads};
    }
    TOILE_HD static ListRows far_rows(const PackedView& table, int leaf, int thread, int threads)
    {
        return {table.far_first[leaf] * Rank + thread, table.far_first[leaf + 1] * Rank, threads};
    }

    /// @param sources  [slots] r
    template <typename Vector>
    TOILE_HD void add_near(const PackedView& table, View<const Vector> sources, const ListRows& list)
    {
        add_rows(list, sources, [&](int k) -> Row {
            const int entry = k / kNodes;
            const auto scale = LoadedNumbers<float, 2>::from(&table.near_scales[2 * entry]);
            return {codes(table.near_codes, k), scale.number[0], scale.number[1],
                    table.near_leaf[entry] * kNodes + k % kNodes};
        });
    }

    /// @param moments  [Rank * clusters] m
    template <typename Vector>
    TOILE_HD void add_far(const PackedView& table, View<const Vector> moments, const ListRows& list)
    {
        add_rows(list, moments, [&](int k) -> Row {
            const int entry = k / Rank, function = k % Rank;
            const float* const scales = table.far_scales.data() + std::size_t(entry) * (Rank + 1);
            return {codes(table.far_codes, k), scales[function], scales[Rank],
                    table.far_cluster[entry] * Rank + function};
        });
    }

    /// Sum along axis a.
    TOILE_HD Targets total(int a) const
    {
        Targets all = sum.axis[a];
        all += Targets(common_[a]);
        return all;
    }

private:
    using Codes = LoadedNumbers<std::uint32_t, PackedView::kWords>;
    static constexpr int kNodes = ClusterTree::kLeaf;
    static constexpr int kAtOnce = 3; ///< rows; more would run out of registers

    struct Row {
        Codes codes;
        float base, scale;
        int value; ///< index of the value that the row weighs
    };

    TOILE_HD static Codes codes(const View<const std::uint32_t>& all, int k)
    {
        return Codes::from(all.data() + std::size_t(k) * PackedView::kWords);
    }

    /// @param load  load(k): row k of the list
    template <typename Vector, typename Load>
    TOILE_HD void add_rows(const ListRows& list, View<const Vector> values, const Load& load)
    {
        for (int first = list.next; first < list.end; first += kAtOnce * list.step) {
            Row rows[kAtOnce] = {}; // rows beyond the end weigh nothing
            Vector value[kAtOnce];
            for (int j = 0; j < kAtOnce; ++j)
                if (const int k = first + j * list.step; k < list.end)
                    rows[j] = load(k);
            for (int j = 0; j < kAtOnce; ++j)
                value[j] = values[rows[j].value];
            for (int j = 0; j < kAtOnce; ++j)
                add_row(rows[j], value[j]);
        }
    }

    /// Weight = base + scale (byte - 128). The constant part of one_and_byte() goes to common_, like the
    /// base.
    template <typename Vector>
    TOILE_HD void add_row(const Row& row, const Vector& value)
    {
        constexpr float kInCommon = 1.0F + 128.0F * kByteUnit;
        const float factor = row.scale / kByteUnit, common = row.base - kInCommon * factor;
        Targets code;
        for (int t = 0; t < KernelView::kTargets; ++t)
            code.value[t] = one_and_byte(row.codes.number[t / 4], t % 4);
        for (int a = 0; a < 3; ++a) {
            sum.axis[a] += code * (factor * value[a]);
            common_[a] += common * value[a];
        }
    }

    float common_[3] = {0.0F, 0.0F, 0.0F}; ///< sum of the bases, equal for all targets
};

} // namespace toile
