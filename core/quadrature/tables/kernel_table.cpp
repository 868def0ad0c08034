#include "core/quadrature/tables/kernel_table.h"

#include <algorithm>
#include <atomic>

#include "core/compute/parallel.h"
#include "core/linear/inverse_columns.h"
#include "core/quadrature/clusters/far_clusters.h"

namespace toile {

namespace {

constexpr int kLeaf = ClusterTree::kLeaf;

using Row = InverseColumns::Row;

/// Target leaves per block of columns.
constexpr int kLeavesPerBlock = InverseColumns::kColumns / kLeaf;

/// Rows of the kernel for a few neighbouring leaves: their projection onto every cluster's functions, and the
/// squares from which the error follows.
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
                const auto value = [&](int slot) { return at(slot); };
                basis_.gather(level, c, Row{}, value, View<Row>(moments_));
                squares_[tree.first_of_level(level) + c] =
                    basis_.view().square(level, c, Row{}, value, squares_);
            }
    }

    int rank() const { return basis_.rank(); }

    /// G between a slot and all columns; zero for padding.
    Row at(int slot) const
    {
        const int v = basis_.tree().nodes()[slot];
        return v >= 0 ? rows_[columns_.row_of(v)] : Row{};
    }
    const Row& moment(int cluster, int function) const
    {
        return moments_[size_t(rank()) * cluster + function];
    }
    double moment(int cluster, int function, int column) const { return moment(cluster, function)[column]; }
    double square(int cluster, int column) const { return squares_[cluster][column]; }

private:
    const InverseColumns& columns_;
    const ClusterBasis& basis_;
    InverseColumns::Block rows_;
    std::vector<Row> moments_; ///< [rank * clusters]
    std::vector<Row> squares_; ///< [clusters] sum over their nodes
};

/// Lists and weights of one target leaf.
struct LeafTable {
    std::vector<int> near, far;
    std::vector<float> near_weights, far_weights;
};

/// Receives the entries from descend() and writes them to a LeafTable.
class LeafLists {
public:
    /// @param column  of the leaf's first target
    LeafLists(const KernelRows& rows, int column, LeafTable& table)
        : rows_(rows), column_(column), table_(table)
    {
    }

    void far(int cluster)
    {
        table_.far.push_back(cluster);
        for (int r = 0; r < rows_.rank(); ++r)
            append(rows_.moment(cluster, r), table_.far_weights);
    }
    void near(int leaf)
    {
        table_.near.push_back(leaf);
        for (int j = 0; j < kLeaf; ++j)
            append(rows_.at(leaf * kLeaf + j), table_.near_weights);
    }

private:
    void append(const Row& row, std::vector<float>& out) const
    {
        for (int t = 0; t < kLeaf; ++t)
            out.push_back(float(row[column_ + t]));
    }

    const KernelRows& rows_;
    int column_;
    LeafTable& table_;
};

template <typename T>
void append(const std::vector<T>& from, std::vector<T>& to)
{
    to.insert(to.end(), from.begin(), from.end());
}

/// Table from the parts of all leaves, in order.
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
    const std::vector<double> limits = far_limits(tree, diagonal, settings.tolerance);
    const FarTest is_far{tree.nodes(), diagonal, limits};
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
            for (int leaf = first; leaf < first + count; ++leaf) {
                const int column = (leaf - first) * kLeaf;
                LeafLists lists(rows, column, leaves[leaf]);
                descend(
                    basis.view(), tree.level_count() - 1, 0,
                    [&](int cluster) { return is_far(rows, cluster, leaf, column); }, lists);
            }
            if (progress && !progress(double(++finished) / blocks))
                is_cancelled = true;
        });
    if (is_cancelled)
        return std::nullopt;
    return joined(leaves, basis.rank());
}

} // namespace toile
