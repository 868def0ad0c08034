#pragma once

#include <cmath>

#include "core/quadrature/packed_lists.h"
#include "core/quadrature/tables/table_kernels.h"

/// Splits the entries of a KernelTable into those whose weights may be bytes (PackedView) and the rest.
namespace toile {

/// Criterion for packing an entry: the rounding of a byte is a small fraction of the error that clusters may
/// have (KernelTable::Settings::tolerance),
///
///   sqrt(H_ii mean_C(H_jj)) scale / 2 <= kFraction tolerance (|C| / 8)^(1/4)
///
/// Evaluated per entry, because the effect of rounding grows with the stiffness. Costs: docs/journal/gpu.md.
struct PackingRule {
    /// [-] Square sheets of all stiffnesses have next to no entry above it. At 1 the contraction would
    /// suffer.
    static constexpr double kFraction = 0.1;

    View<const double> limits;           ///< [clusters] far_limits()
    View<const double> largest_diagonal; ///< [leaves] maximum of H_ii

    TOILE_HD bool allows(int leaf, int cluster, float scale) const
    {
        const double rounding = 0.5 * double(scale);
        return largest_diagonal[leaf] * rounding * rounding <= kFraction * kFraction * limits[cluster];
    }
};

/// Packing of an entry's weights: `rows` parts with a base each.
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

    /// Codes of four neighbouring weights of a row.
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
        float min_weight = weights_[row * size_];
        for (int i = 1; i < size_; ++i)
            min_weight = std::fmin(min_weight, weights_[row * size_ + i]);
        return min_weight;
    }
    TOILE_HD float high(int row) const
    {
        float max_weight = weights_[row * size_];
        for (int i = 1; i < size_; ++i)
            max_weight = std::fmax(max_weight, weights_[row * size_ + i]);
        return max_weight;
    }

    const float* weights_;
    int size_;
    float scale_;
};

/// Entries of all leaves towards leaves, or towards clusters.
struct EntryList {
    View<const int> first;  ///< [leaves + 1]
    View<const int> source; ///< [entries] leaf or cluster
    View<const float> weights;
    int rows; ///< parts of an entry's weights, with a base each
    int row_size;

    TOILE_HD const float* of(int entry) const
    {
        return weights.data() + std::size_t(entry) * rows * row_size;
    }
    TOILE_HD EntryPacking packing(int entry) const { return {of(entry), rows, row_size}; }

    /// Lists of a table towards leaves (near) or clusters (far).
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

/// Sets 1 for an entry e that may be packed. Clusters of the lowest level are leaves, so one numbering serves
/// both lists.
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

/// Output positions of the entries: packed ones and the others, each in their order.
struct PackedSlots {
    View<const int> chosen;  ///< [entries + 1], 0 in the last
    View<const long> before; ///< [entries + 1] packed entries before an entry

    TOILE_HD int packed(int e) const { return int(before[e]); }
    TOILE_HD int rest(int e) const { return e - int(before[e]); }
};

/// First entries of a leaf in the two lists; item `leaves` gives the end of the last.
struct SplitFirsts {
    PackedSlots slots;
    View<const int> first;
    View<int> packed_first, rest_first; ///< [leaves + 1] out

    TOILE_HD void operator()(int leaf) const
    {
        packed_first[leaf] = slots.packed(first[leaf]);
        rest_first[leaf] = slots.rest(first[leaf]);
    }
};

/// Writes entry e to its list, as bytes or with its weights unchanged.
struct SplitEntry {
    EntryList list;
    PackedSlots slots;
    bool is_near;
    View<int> packed_source;          ///< out, like the members below
    View<std::uint32_t> packed_codes; ///< see PackedView
    View<float> packed_scales;
    View<int> rest_source;
    View<float> rest_weights;

    TOILE_HD void operator()(int e) const
    {
        const int size = list.rows * list.row_size;
        if (slots.chosen[e] == 0) {
            const int to = slots.rest(e);
            rest_source[to] = list.source[e];
            for (int i = 0; i < size; ++i)
                rest_weights[std::size_t(to) * size + i] = list.of(e)[i];
            return;
        }
        const int to = slots.packed(e);
        packed_source[to] = list.source[e];
        is_near ? pack_near(e, to) : pack_far(e, to);
    }

private:
    /// Writes one base for all weights.
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

    /// Writes one base per function.
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
