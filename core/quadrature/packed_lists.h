#pragma once

#include <cstdint>

#include "core/backend/bits.h"
#include "core/quadrature/leaf_sum.h"

namespace toile {

/// Lists of a KernelTable with a byte for every weight, which is
///
///   base + scale (byte - 128)
///
/// Towards a leaf all weights have one base, towards a cluster those of each function; all of an entry have
/// one scale. What a kernel has in common between neighbours, its largest part by far where a body is free or
/// stiff, is in the base and so in single precision.
struct PackedView {
    static constexpr int kWords = KernelView::kTargets / 4; ///< of four bytes, of the targets

    View<const int> near_first;           ///< [leaves + 1] into near_leaf
    View<const int> near_leaf;            ///< source leaves
    View<const std::uint32_t> near_codes; ///< [near_leaf][source node][kWords]
    View<const float> near_scales;        ///< [near_leaf][2] base and scale [m/N]
    View<const int> far_first;            ///< [leaves + 1] into far_cluster
    View<const int> far_cluster;          ///< source clusters
    View<const std::uint32_t> far_codes;  ///< [far_cluster][rank][kWords]
    View<const float> far_scales;         ///< [far_cluster][rank + 1] bases of the functions, scale [m/N]
};

/// Numbers that a thread loads at once.
template <typename Number, int Count>
struct alignas(sizeof(Number) * (Count % 4 == 0   ? 4
                                 : Count % 2 == 0 ? 2
                                                  : 1)) LoadedNumbers {
    Number number[Count];

    /// @param from  aligned as this is
    TOILE_HD static LoadedNumbers from(const Number* numbers)
    {
        return *reinterpret_cast<const LoadedNumbers*>(numbers);
    }
};

/// The rows of a leaf's list that a thread has: source nodes, or functions of clusters, next, next + step and
/// so on.
struct ListRows {
    int next = 0;
    int end = 0;
    int step = 1;
};

/// LeafSum over packed lists: of all targets, from every `step`-th source node and function of a cluster.
///
/// A thread has one of those at a time, and its neighbour the next: what they load is side by side. Threads
/// that take whole entries load three times as often from places far apart. Of a few rows all is loaded
/// before any of it is needed, so that loads don't wait for each other.
template <int Rank>
struct PackedSum {
    using Targets = Floats<KernelView::kTargets>;

    /// All but what bases add; what is not packed may be added to it.
    LeafSum<Rank, Targets> sum;

    /// The rows of a leaf that are thread `thread`'s of `threads`.
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

    /// What has been added up along an axis.
    TOILE_HD Targets total(int a) const
    {
        Targets all = sum.axis[a];
        all += Targets(common_[a]);
        return all;
    }

private:
    using Codes = LoadedNumbers<std::uint32_t, PackedView::kWords>;
    static constexpr int kNodes = ClusterTree::kLeaf;
    static constexpr int kAtOnce = 3; ///< rows: with more, registers are short

    struct Row {
        Codes codes;
        float base, scale;
        int value; ///< number of what it weighs
    };

    TOILE_HD static Codes codes(const View<const std::uint32_t>& all, int k)
    {
        return Codes::from(all.data() + std::size_t(k) * PackedView::kWords);
    }

    /// @param load  row k of the list
    template <typename Vector, typename Load>
    TOILE_HD void add_rows(const ListRows& list, View<const Vector> values, const Load& load)
    {
        for (int first = list.next; first < list.end; first += kAtOnce * list.step) {
            Row rows[kAtOnce] = {}; // beyond the end of the list they weigh nothing
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

    /// A weight is base + scale (byte - 128), and what one_and_byte() has in common of all bytes comes to
    /// common_ as the base does.
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

    float common_[3] = {0.0F, 0.0F, 0.0F}; ///< of all targets: what bases add
};

} // namespace toile
