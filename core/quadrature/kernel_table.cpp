#include "core/quadrature/kernel_table.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/backend/parallel.h"
#include "core/linear/inverse_columns.h"

namespace toile {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;

using Row = InverseColumns::Row;

/// Target leaves that one block of columns serves.
constexpr int kLeavesPerBlock = InverseColumns::kColumns / kLeaf;

/// Growth of the squared error that is let pass from one level to the next, twice as many nodes [-]. What
/// functions leave out is smooth inside a cluster and jumps at its rim: H weighs the jumps, and the rim grows
/// with the square root of a surface's nodes. At 1 and at 2 the same contraction takes longer lists. A
/// volume's rim grows faster, but with 2^(2/3) large blocks no longer contracted; from 1 to 2^(1/2) it makes
/// no difference there.
constexpr double kGrowth = 1.4142135623730951;

/// Mean of a field over the nodes of every cluster.
std::vector<double> cluster_means(const ClusterTree& tree, View<const double> field)
{
    std::vector<double> sums(tree.cluster_count(), 0.0);
    std::vector<int> counts(tree.cluster_count(), 0);
    for (int slot = 0; slot < tree.nodes().size(); ++slot)
        if (const int v = tree.nodes()[slot]; v >= 0) {
            sums[slot / kLeaf] += field[v];
            ++counts[slot / kLeaf];
        }
    for (int level = 1; level < tree.level_count(); ++level)
        for (int c = 0; c < tree.level_size(level); ++c)
            for (int which = 0; which < 2; ++which)
                if (const int child = tree.child(level, c, which); child >= 0) {
                    sums[tree.first_of_level(level) + c] += sums[child];
                    counts[tree.first_of_level(level) + c] += counts[child];
                }
    for (int id = 0; id < tree.cluster_count(); ++id)
        sums[id] /= counts[id];
    return sums;
}

/// Rows of the kernel for a few neighbouring leaves: what every cluster's functions carry of them, and how
/// much they leave out.
class KernelRows {
public:
    KernelRows(const InverseColumns& columns, const ClusterBasis& basis)
        : columns_(columns), basis_(basis), moments_(size_t(basis.rank()) * basis.tree().cluster_count()),
          squares_(basis.tree().cluster_count())
    {
    }

    void solve(int first_leaf, int leaf_count)
    {
        const ClusterTree& tree = basis_.tree();
        std::vector<int> targets;
        for (int slot = first_leaf * kLeaf; slot < (first_leaf + leaf_count) * kLeaf; ++slot)
            if (const int v = tree.nodes()[slot]; v >= 0)
                targets.push_back(v);
        columns_.solve(targets, rows_);
        for (int level = 0; level < tree.level_count(); ++level)
            for (int c = 0; c < tree.level_size(level); ++c) {
                basis_.gather(
                    level, c, Row{}, [&](int slot) { return at(slot); }, View<Row>(moments_));
                sum_squares(level, c);
            }
    }

    int rank() const { return basis_.rank(); }

    /// G between a slot and all columns; zero where the slot is padding.
    Row at(int slot) const
    {
        const int v = basis_.tree().nodes()[slot];
        return v >= 0 ? rows_[columns_.row_of(v)] : Row{};
    }
    const Row& moment(int cluster, int function) const
    {
        return moments_[size_t(rank()) * cluster + function];
    }

    /// |G_iC - P_C P_C^T G_iC|^2 for one column
    double squared_error(int cluster, int column) const
    {
        double rest = squares_[cluster][column];
        for (int r = 0; r < rank(); ++r)
            rest -= std::pow(moment(cluster, r)[column], 2);
        return rest;
    }

private:
    void sum_squares(int level, int c)
    {
        const ClusterTree& tree = basis_.tree();
        const int id = tree.first_of_level(level) + c;
        squares_[id] = Row{};
        if (level == 0)
            for (int slot = id * kLeaf; slot < (id + 1) * kLeaf; ++slot)
                squares_[id] += squared(at(slot));
        else
            for (int which = 0; which < 2; ++which)
                if (const int child = tree.child(level, c, which); child >= 0)
                    squares_[id] += squares_[child];
    }

    const InverseColumns& columns_;
    const ClusterBasis& basis_;
    InverseColumns::Block rows_;
    std::vector<Row> moments_; ///< [rank * clusters]
    std::vector<Row> squares_; ///< [clusters] sum over their nodes
};

/// The lists and weights of one target leaf.
struct LeafTable {
    std::vector<int> near, far;
    std::vector<float> near_weights, far_weights;
};

/// Chooses the largest clusters that carry the rows of one leaf accurately enough.
class LeafBuilder {
public:
    LeafBuilder(const KernelRows& rows, const ClusterTree& tree, View<const double> diagonal,
                View<const double> mean_diagonal, double tolerance)
        : rows_(rows), tree_(tree), diagonal_(diagonal), mean_diagonal_(mean_diagonal), tolerance_(tolerance)
    {
    }

    /// @param column  of the leaf's first target
    LeafTable build(int leaf, int column)
    {
        target_ = leaf;
        column_ = column;
        LeafTable table;
        descend(tree_.level_count() - 1, 0, table);
        return table;
    }

private:
    void descend(int level, int c, LeafTable& table) const
    {
        const int id = tree_.first_of_level(level) + c;
        if (is_accurate(level, id)) {
            table.far.push_back(id);
            for (int r = 0; r < rows_.rank(); ++r)
                append(rows_.moment(id, r), table.far_weights);
        } else if (level == 0) {
            table.near.push_back(c);
            for (int j = 0; j < kLeaf; ++j)
                append(rows_.at(c * kLeaf + j), table.near_weights);
        } else {
            for (int which = 0; which < 2; ++which)
                if (tree_.child(level, c, which) >= 0)
                    descend(level - 1, 2 * c + which, table);
        }
    }

    bool is_accurate(int level, int id) const
    {
        const double limit = tolerance_ * tolerance_ * std::pow(kGrowth, level) / mean_diagonal_[id];
        for (int t = 0; t < kLeaf; ++t) {
            const int v = tree_.nodes()[target_ * kLeaf + t];
            if (v >= 0 && diagonal_[v] * rows_.squared_error(id, column_ + t) > limit)
                return false;
        }
        return true;
    }

    void append(const Row& row, std::vector<float>& out) const
    {
        for (int t = 0; t < kLeaf; ++t)
            out.push_back(float(row[column_ + t]));
    }

    const KernelRows& rows_;
    const ClusterTree& tree_;
    View<const double> diagonal_, mean_diagonal_;
    double tolerance_;
    int target_ = 0, column_ = 0;
};

template <typename T>
void append(const std::vector<T>& from, std::vector<T>& to)
{
    to.insert(to.end(), from.begin(), from.end());
}

/// One leaf after the other.
KernelTable joined(const std::vector<LeafTable>& leaves, int rank)
{
    KernelTable table;
    table.rank = rank;
    for (const LeafTable& leaf : leaves) {
        table.near_first.push_back(int(table.near_leaf.size()));
        table.far_first.push_back(int(table.far_cluster.size()));
        append(leaf.near, table.near_leaf);
        append(leaf.far, table.far_cluster);
        append(leaf.near_weights, table.near_weights);
        append(leaf.far_weights, table.far_weights);
    }
    table.near_first.push_back(int(table.near_leaf.size()));
    table.far_first.push_back(int(table.far_cluster.size()));
    return table;
}

} // namespace

double KernelTable::gathers_per_node() const
{
    const double leaves = std::max(double(near_first.size()) - 1.0, 1.0);
    return (double(near_leaf.size()) * kLeaf + double(far_cluster.size()) * rank) / leaves;
}

std::optional<KernelTable> build_kernel_table(const SupernodalFactor& factor, View<const double> diagonal,
                                              const ClusterBasis& basis,
                                              const KernelTable::Settings& settings,
                                              const BuildProgress& progress)
{
    const StageScope stage("quadrature/build");
    const ClusterTree& tree = basis.tree();
    const std::vector<double> mean_diagonal = cluster_means(tree, diagonal);
    const InverseColumns columns(factor);
    std::vector<LeafTable> leaves(tree.leaf_count());
    const int blocks = (tree.leaf_count() + kLeavesPerBlock - 1) / kLeavesPerBlock;
    std::atomic<int> finished = 0;
    std::atomic<bool> is_cancelled = false;
    parallel_tasks_with(
        kCpu, "quadrature/rows", blocks, [&] { return KernelRows(columns, basis); },
        [&](int block, KernelRows& rows) {
            if (is_cancelled)
                return;
            const int first = block * kLeavesPerBlock;
            const int count = std::min(kLeavesPerBlock, tree.leaf_count() - first);
            rows.solve(first, count);
            LeafBuilder builder(rows, tree, diagonal, mean_diagonal, settings.tolerance);
            for (int leaf = first; leaf < first + count; ++leaf)
                leaves[leaf] = builder.build(leaf, (leaf - first) * kLeaf);
            if (progress && !progress(double(++finished) / blocks))
                is_cancelled = true;
        });
    if (is_cancelled)
        return std::nullopt;
    return joined(leaves, basis.rank());
}

} // namespace toile
