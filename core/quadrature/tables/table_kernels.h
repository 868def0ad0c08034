#pragma once

#include "core/linear/inverse_kernels.h"
#include "core/quadrature/clusters/far_clusters.h"
#include "core/quadrature/clusters/leaf_sum.h"

/// Lists and weights of a block of target leaves from their columns of the inverse, on a GPU.
/// DeviceTableBuilder launches these kernels.
namespace toile {

/// Columns of the inverse in the order of the leaves' slots.
struct SlotColumns {
    View<const int> row_of_slot; ///< [slots] row of the block, -1 where padded
    ColumnBlock inverse;

    TOILE_HD double operator()(int slot, int column) const
    {
        const int row = row_of_slot[slot];
        return row >= 0 ? inverse.row(row)[column] : 0.0;
    }
};

/// Moments and squares of the columns for all clusters: the Rows of clusters/far_clusters.h.
struct ClusterColumns {
    int functions = 0;
    ColumnBlock moments; ///< [clusters * functions]
    ColumnBlock squares; ///< [clusters]

    TOILE_HD int rank() const { return functions; }
    TOILE_HD double moment(int cluster, int function, int column) const
    {
        return moments.row(cluster * functions + function)[column];
    }
    TOILE_HD double square(int cluster, int column) const { return squares.row(cluster)[column]; }
};

/// Moments and squares of one level's clusters, children before parents.
///
/// Item i is a column of a cluster.
struct GatherColumns {
    BasisView<double> basis;
    SlotColumns slots;
    ClusterColumns clusters;
    int level = 0;
    int columns = 0; ///< of the block

    TOILE_HD void operator()(int i) const
    {
        const int column = i % columns, c = i / columns, id = basis.first_of_level[level] + c;
        const AtSlot value{slots, column};
        const ColumnOf moments{clusters.moments, column}, squares{clusters.squares, column};
        for (int r = 0; r < basis.rank; ++r)
            clusters.moments.row(id * basis.rank + r)[column] =
                basis.moment(level, c, r, 0.0, value, moments);
        clusters.squares.row(id)[column] = basis.square(level, c, 0.0, value, squares);
    }

private:
    struct AtSlot {
        SlotColumns slots;
        int column;
        TOILE_HD double operator()(int slot) const { return slots(slot, column); }
    };
    struct ColumnOf {
        ColumnBlock block;
        int column;
        TOILE_HD double operator[](int row) const { return block.row(row)[column]; }
    };
};

/// Entries that one target leaf finds below one cluster of a level. If an ancestor of that cluster is far,
/// its first descendant lists it. There are at most as many entries as leaves below the cluster: near entries
/// fill its part of `found` from the beginning, far entries from the end, backwards.
struct FoundEntries {
    static constexpr int kLevel = 4; ///< of the clusters; lower if the root is
    static constexpr int kMax = 1 << kLevel;

    View<int> found;      ///< [target leaves][clusters of the level][kMax]
    View<int> near_count; ///< [target leaves][clusters of the level]
    View<int> far_count;

    TOILE_HD int& near(int part, int k) const { return found[part * kMax + k]; }
    TOILE_HD int& far(int part, int k) const { return found[(part + 1) * kMax - 1 - k]; }
};

/// Target leaves of one block, and the number of parts of each leaf's search.
struct LeafBlock {
    int first = 0; ///< leaf
    int count = 0;
    int parts = 0; ///< per leaf: clusters of the level where searches begin
    int part_level = 0;
};

/// Finds the entries of a leaf below one cluster.
///
/// Item i is a leaf of the block. Leaves of the same part are adjacent, because they read neighbouring
/// columns.
struct FindEntries {
    BasisView<double> tree;
    FarTest is_far;
    ClusterColumns clusters;
    LeafBlock block;
    FoundEntries entries;

    TOILE_HD void operator()(int i) const
    {
        const int leaf = i % block.count, start = i / block.count;
        const IsFar test{*this, block.first + leaf, leaf * ClusterTree::kLeaf};
        Lists lists{entries, leaf * block.parts + start, 0, 0};
        find(test, start, lists);
        entries.near_count[lists.part] = lists.near_count;
        entries.far_count[lists.part] = lists.far_count;
    }

private:
    struct IsFar {
        const FindEntries& kernel;
        int leaf, column;
        TOILE_HD bool operator()(int cluster) const
        {
            return kernel.is_far(kernel.clusters, cluster, leaf, column);
        }
    };
    struct Lists {
        FoundEntries entries;
        int part, near_count, far_count;
        TOILE_HD void near(int leaf) { entries.near(part, near_count++) = leaf; }
        TOILE_HD void far(int cluster) { entries.far(part, far_count++) = cluster; }
    };

    TOILE_HD void find(const IsFar& test, int start, Lists& lists) const
    {
        // A far ancestor represents all clusters below it; the first of them lists it.
        int root_level = block.part_level;
        while (level_size(tree.leaf_count, root_level) > 1)
            ++root_level;
        for (int level = root_level; level > block.part_level; --level) {
            const int shift = level - block.part_level, c = start >> shift;
            if (const int id = tree.first_of_level[level] + c; test(id)) {
                if (start == c << shift)
                    lists.far(id);
                return;
            }
        }
        descend(tree, block.part_level, start, test, lists);
    }
};

/// Positions of the parts' entries in the table, after those of earlier parts.
struct EntryOffsets {
    View<const long> near, far; ///< [parts + 1] exclusive sums, the total last
    int first_near = 0;         ///< entries of earlier blocks
    int first_far = 0;
};

/// Numbers of near and far entries of the block.
struct CountEntries {
    EntryOffsets offsets;
    View<int> totals; ///< [2]

    TOILE_HD void operator()(int i) const
    {
        const View<const long>& sums = i == 0 ? offsets.near : offsets.far;
        totals[i] = int(sums[sums.size() - 1]);
    }
};

/// First entries of every leaf of the block, and of the leaf after it.
struct WriteFirsts {
    EntryOffsets offsets;
    LeafBlock block;
    View<int> near_first, far_first; ///< [leaves + 1]

    TOILE_HD void operator()(int leaf) const
    {
        near_first[block.first + leaf] = offsets.first_near + int(offsets.near[leaf * block.parts]);
        far_first[block.first + leaf] = offsets.first_far + int(offsets.far[leaf * block.parts]);
    }
};

/// Writes the entries of one part to the table.
struct WriteEntries {
    FoundEntries entries;
    EntryOffsets offsets;
    View<int> near_leaf, far_cluster;

    TOILE_HD void operator()(int part) const
    {
        const int first_near = offsets.first_near + int(offsets.near[part]);
        const int first_far = offsets.first_far + int(offsets.far[part]);
        for (int k = 0; k < entries.near_count[part]; ++k)
            near_leaf[first_near + k] = entries.near(part, k);
        for (int k = 0; k < entries.far_count[part]; ++k)
            far_cluster[first_far + k] = entries.far(part, k);
    }
};

/// Leaf of a block whose list contains an entry.
/// @param first  [leaves + 1] begin of the lists
TOILE_HD inline int leaf_of_entry(View<const int> first, const LeafBlock& block, int entry)
{
    int low = block.first, high = block.first + block.count - 1;
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (first[middle] <= entry)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

/// Writes the weights of the entries from `first_entry` on; item i is one target of one entry.
struct WriteNearWeights {
    SlotColumns slots;
    LeafBlock block;
    int first_entry = 0;
    View<const int> near_first, near_leaf;
    View<float> near_weights;

    TOILE_HD void operator()(int i) const
    {
        constexpr int kTargets = KernelView::kTargets;
        const int entry = first_entry + i / kTargets, target = i % kTargets;
        const int column = (leaf_of_entry(near_first, block, entry) - block.first) * kTargets + target;
        const int slot = near_leaf[entry] * ClusterTree::kLeaf;
        float* const weights =
            near_weights.data() + std::size_t(entry) * ClusterTree::kLeaf * kTargets + target;
        for (int j = 0; j < ClusterTree::kLeaf; ++j)
            weights[j * kTargets] = float(slots(slot + j, column));
    }
};
struct WriteFarWeights {
    ClusterColumns clusters;
    LeafBlock block;
    int first_entry = 0;
    View<const int> far_first, far_cluster;
    View<float> far_weights;

    TOILE_HD void operator()(int i) const
    {
        constexpr int kTargets = KernelView::kTargets;
        const int entry = first_entry + i / kTargets, target = i % kTargets;
        const int column = (leaf_of_entry(far_first, block, entry) - block.first) * kTargets + target;
        float* const weights =
            far_weights.data() + std::size_t(entry) * clusters.functions * kTargets + target;
        for (int r = 0; r < clusters.functions; ++r)
            weights[r * kTargets] = float(clusters.moment(far_cluster[entry], r, column));
    }
};

} // namespace toile
