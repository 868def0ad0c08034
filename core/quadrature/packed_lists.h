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
    static constexpr int kHalf = KernelView::kTargets / 2; ///< of targets, or of a leaf's sources

    View<const int> near_first;           ///< [leaves + 1] into near_leaf
    View<const int> near_leaf;            ///< source leaves
    View<const std::uint32_t> near_codes; ///< [near_leaf][half of sources][half of targets][kHalf sources]
    View<const float> near_scales;        ///< [near_leaf][2] base and scale [m/N]
    View<const int> far_first;            ///< [leaves + 1] into far_cluster
    View<const int> far_cluster;          ///< source clusters
    View<const std::uint32_t> far_codes;  ///< [far_cluster][half of targets][rank]
    View<const float> far_scales;         ///< [far_cluster][rank + 1] bases of the functions, scale [m/N]

    static constexpr int kNearWords = 4 * kHalf;
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

/// What one of several adds up of a leaf from packed lists: a half of the targets, every `groups`-th entry
/// from `group` on (near ones by halves of their sources).
struct PackedPart {
    int half = 0;
    int group = 0;
    int groups = 1;
};

/// LeafSum over packed lists, for half of the targets.
template <int Rank>
struct PackedSum {
    using Targets = Floats<PackedView::kHalf>;
    Targets axis[3] = {Targets(0.0F), Targets(0.0F), Targets(0.0F)}; ///< x, y and z of the targets

    /// @param sources  [slots] r
    /// @param moments  [Rank * clusters] m
    template <typename Vector>
    TOILE_HD void add(const PackedView& table, View<const Vector> sources, View<const Vector> moments,
                      int leaf, const PackedPart& part)
    {
        constexpr int kHalf = PackedView::kHalf;
        TOILE_UNROLL(2)
        for (int e = 2 * table.near_first[leaf] + part.group; e < 2 * table.near_first[leaf + 1];
             e += part.groups) {
            const auto codes = LoadedNumbers<std::uint32_t, kHalf>::from(
                table.near_codes.data() + std::size_t(2 * e + part.half) * kHalf);
            const auto scale = LoadedNumbers<float, 2>::from(&table.near_scales[e / 2 * 2]);
            const Vector* const values =
                &sources[table.near_leaf[e / 2] * ClusterTree::kLeaf + e % 2 * kHalf];
            for (int k = 0; k < kHalf; ++k)
                add_weights(codes.number[k], scale.number[0], scale.number[1], values[k]);
        }
        TOILE_UNROLL(2)
        for (int e = table.far_first[leaf] + part.group; e < table.far_first[leaf + 1]; e += part.groups) {
            const auto codes = LoadedNumbers<std::uint32_t, Rank>::from(
                table.far_codes.data() + std::size_t(2 * e + part.half) * Rank);
            const auto scale =
                LoadedNumbers<float, Rank + 1>::from(table.far_scales.data() + std::size_t(e) * (Rank + 1));
            const Vector* const values = &moments[table.far_cluster[e] * Rank];
            for (int k = 0; k < Rank; ++k)
                add_weights(codes.number[k], scale.number[k], scale.number[Rank], values[k]);
        }
        for (int a = 0; a < 3; ++a)
            axis[a] += Targets(common_[a]);
    }

private:
    template <typename Vector>
    TOILE_HD void add_weights(std::uint32_t codes, float base, float scale, const Vector& value)
    {
        Targets code(0.0F);
        for (int t = 0; t < PackedView::kHalf; ++t)
            code.value[t] = byte_minus_128(codes, t);
        for (int a = 0; a < 3; ++a) {
            axis[a] += code * (scale * value[a]);
            common_[a] += base * value[a];
        }
    }

    float common_[3] = {0.0F, 0.0F, 0.0F}; ///< of all targets: what bases add
};

} // namespace toile
