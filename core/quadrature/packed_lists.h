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

/// LeafSum over packed lists: of all targets, from every `step`-th source node and function of a cluster.
///
/// A thread has one of those at a time, and its neighbour the next: what they load is side by side. Threads
/// that take whole entries load three times as often from places far apart.
template <int Rank>
struct PackedSum {
    using Targets = Floats<KernelView::kTargets>;

    /// All but what bases add; what is not packed may be added to it.
    LeafSum<Rank, Targets> sum;

    /// Near entries.
    /// @param sources  [slots] r
    /// @param begin    the first node of a list that is taken
    template <typename Vector>
    TOILE_HD void add_near(const PackedView& table, View<const Vector> sources, int leaf, int begin, int step)
    {
        constexpr int kNodes = ClusterTree::kLeaf;
        TOILE_UNROLL(2)
        for (int k = table.near_first[leaf] * kNodes + begin; k < table.near_first[leaf + 1] * kNodes;
             k += step) {
            const int entry = k / kNodes;
            const auto scale = LoadedNumbers<float, 2>::from(&table.near_scales[2 * entry]);
            add_weights(codes(table.near_codes, k), scale.number[0], scale.number[1],
                        sources[table.near_leaf[entry] * kNodes + k % kNodes]);
        }
    }

    /// Far entries.
    /// @param moments  [Rank * clusters] m
    /// @param begin    the first function of a list that is taken
    template <typename Vector>
    TOILE_HD void add_far(const PackedView& table, View<const Vector> moments, int leaf, int begin, int step)
    {
        TOILE_UNROLL(4)
        for (int k = table.far_first[leaf] * Rank + begin; k < table.far_first[leaf + 1] * Rank; k += step) {
            const int entry = k / Rank, function = k % Rank;
            const float* const scales = table.far_scales.data() + std::size_t(entry) * (Rank + 1);
            add_weights(codes(table.far_codes, k), scales[function], scales[Rank],
                        moments[table.far_cluster[entry] * Rank + function]);
        }
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

    TOILE_HD static Codes codes(const View<const std::uint32_t>& all, int k)
    {
        return Codes::from(all.data() + std::size_t(k) * PackedView::kWords);
    }

    template <typename Vector>
    TOILE_HD void add_weights(const Codes& codes, float base, float scale, const Vector& value)
    {
        Targets code(0.0F);
        for (int t = 0; t < KernelView::kTargets; ++t)
            code.value[t] = byte_minus_128(codes.number[t / 4], t % 4);
        for (int a = 0; a < 3; ++a) {
            sum.axis[a] += code * (scale * value[a]);
            common_[a] += base * value[a];
        }
    }

    float common_[3] = {0.0F, 0.0F, 0.0F}; ///< of all targets: what bases add
};

} // namespace toile
