#pragma once

#include <cmath>

#include "core/quadrature/packed_lists.h"
#include "core/quadrature/table_kernels.h"

/// Sorting the entries of a KernelTable into those whose weights may be bytes (PackedView) and the rest.
namespace toile {

/// Which entries may be packed: those in which a byte's rounding is a small part of what clusters may leave
/// out anyway (KernelTable::Settings::tolerance),
///
///   sqrt(H_ii mean_C(H_jj)) scale / 2 <= kShare tolerance (|C| / 8)^(1/4)
///
/// Asked entry by entry, for rounding weighs with the stiffness: docs/benchmarks/gpu.md has what it costs.
struct PackingRule {
    /// [-] Square sheets of all stiffnesses have next to no entry above it. At 1 contraction would suffer.
    static constexpr double kShare = 0.1;

    View<const double> limits;           ///< [clusters] far_limits()
    View<const double> largest_diagonal; ///< [leaves] of H_ii

    TOILE_HD bool allows(int leaf, int cluster, float scale) const
    {
        const double rounding = 0.5 * double(scale);
        return largest_diagonal[leaf] * rounding * rounding <= kShare * kShare * limits[cluster];
    }
};

/// How the weights of an entry are packed: in `rows` parts with a base each.
class EntryPacking {
public:
    static constexpr int kSteps = 255; ///< of a byte

    /// @param weights   [rows * row_size]
    TOILE_HD EntryPacking(const float* weights, int rows, int row_size) : weights_(weights), size_(row_size)
    {
        float widest = 0.0F;
        for (int r = 0; r < rows; ++r)
            widest = std::fmax(widest, high(r) - low(r));
        scale_ = widest / float(kSteps);
    }

    TOILE_HD float scale() const { return scale_; }
    TOILE_HD float base(int row) const { return float(double(low(row)) + 128.0 * double(scale_)); }

    /// Four neighbouring weights of a row.
    TOILE_HD std::uint32_t codes(const float* first, float base) const
    {
        std::uint32_t word = 0;
        for (int t = 0; t < 4; ++t) {
            const double steps = scale_ > 0.0F ? (double(first[t]) - double(base)) / double(scale_) : 0.0;
            const double code = std::fmin(std::fmax(std::floor(steps + 128.5), 0.0), double(kSteps));
            word |= std::uint32_t(code) << (8 * t);
        }
        return word;
    }

private:
    TOILE_HD float low(int row) const
    {
        float least = weights_[row * size_];
        for (int i = 1; i < size_; ++i)
            least = std::fmin(least, weights_[row * size_ + i]);
        return least;
    }
    TOILE_HD float high(int row) const
    {
        float most = weights_[row * size_];
        for (int i = 1; i < size_; ++i)
            most = std::fmax(most, weights_[row * size_ + i]);
        return most;
    }

    const float* weights_;
    int size_;
    float scale_;
};

/// The entries of a leaf towards leaves, or towards clusters.
struct EntryList {
    View<const int> first;  ///< [leaves + 1]
    View<const int> source; ///< [entries] leaf or cluster
    View<const float> weights;
    int rows; ///< parts of an entry's weights that have a base each
    int row_size;

    TOILE_HD const float* of(int entry) const
    {
        return weights.data() + std::size_t(entry) * rows * row_size;
    }
    TOILE_HD EntryPacking packing(int entry) const { return {of(entry), rows, row_size}; }

    /// Towards leaves, or clusters, of a table.
    TOILE_HD static EntryList near(const KernelView& table)
    {
        return {table.near_first, table.near_leaf, table.near_weights, 1,
                ClusterTree::kLeaf * KernelView::kTargets};
    }
    TOILE_HD static EntryList far(const KernelView& table, int rank)
    {
        return {table.far_first, table.far_cluster, table.far_weights, rank, KernelView::kTargets};
    }
};

/// 1 where entry e may be packed. Clusters at the lowest level are leaves: one numbering serves both lists.
struct ChooseToPack {
    EntryList list;
    PackingRule rule;
    View<int> chosen; ///< [entries] out

    TOILE_HD void operator()(int e) const
    {
        const int leaf = leaf_of_entry(list.first, {0, list.first.size() - 1, 0, 0}, e);
        chosen[e] = rule.allows(leaf, list.source[e], list.packing(e).scale()) ? 1 : 0;
    }
};

/// Where entries go: chosen ones in their order, and the others in theirs.
struct PackedPlaces {
    View<const int> chosen;  ///< [entries + 1], 0 in the last
    View<const long> before; ///< [entries + 1] chosen ones before an entry

    TOILE_HD int packed(int e) const { return int(before[e]); }
    TOILE_HD int rest(int e) const { return e - int(before[e]); }
};

/// Begin of the two lists of a leaf, and of what is behind the last.
struct SplitFirsts {
    PackedPlaces places;
    View<const int> first;
    View<int> packed_first, rest_first; ///< [leaves + 1] out

    TOILE_HD void operator()(int leaf) const
    {
        packed_first[leaf] = places.packed(first[leaf]);
        rest_first[leaf] = places.rest(first[leaf]);
    }
};

/// Puts entry e where it belongs: bytes, or the weights as they are.
struct SplitEntry {
    EntryList list;
    PackedPlaces places;
    bool is_near;
    View<int> packed_source;          ///< out, as all that follow
    View<std::uint32_t> packed_codes; ///< as PackedView's
    View<float> packed_scales;
    View<int> rest_source;
    View<float> rest_weights;

    TOILE_HD void operator()(int e) const
    {
        const int size = list.rows * list.row_size;
        if (places.chosen[e] == 0) {
            const int to = places.rest(e);
            rest_source[to] = list.source[e];
            for (int i = 0; i < size; ++i)
                rest_weights[std::size_t(to) * size + i] = list.of(e)[i];
            return;
        }
        const int to = places.packed(e);
        packed_source[to] = list.source[e];
        is_near ? pack_near(e, to) : pack_far(e, to);
    }

private:
    /// One base for all weights.
    TOILE_HD void pack_near(int e, int to) const
    {
        const EntryPacking packing = list.packing(e);
        const float base = packing.base(0);
        packed_scales[2 * to] = base;
        packed_scales[2 * to + 1] = packing.scale();
        constexpr int kWords = ClusterTree::kLeaf * PackedView::kWords;
        for (int word = 0; word < kWords; ++word)
            packed_codes[to * kWords + word] = packing.codes(list.of(e) + 4 * word, base);
    }

    /// A base for each function.
    TOILE_HD void pack_far(int e, int to) const
    {
        const EntryPacking packing = list.packing(e);
        const int rank = list.rows, words = rank * PackedView::kWords;
        packed_scales[to * (rank + 1) + rank] = packing.scale();
        for (int r = 0; r < rank; ++r)
            packed_scales[to * (rank + 1) + r] = packing.base(r);
        for (int word = 0; word < words; ++word)
            packed_codes[to * words + word] =
                packing.codes(list.of(e) + 4 * word, packing.base(word / PackedView::kWords));
    }
};

} // namespace toile
