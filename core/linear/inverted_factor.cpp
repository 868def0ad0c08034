#include "core/linear/inverted_factor.h"

#include <algorithm>
#include <limits>
#include <string>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/linear/inverse_columns.h"

namespace toile {

namespace {

using Row = InverseColumns::Row;
using Supernode = SupernodalFactor::Supernode;

constexpr int kColumns = InverseColumns::kColumns;

int rounded_up(int number, int multiple) { return (number + multiple - 1) / multiple * multiple; }

std::vector<int> supernodes_of_columns(const SupernodalFactor& factor)
{
    std::vector<int> result(factor.permutation.size());
    for (int s = 0; s < int(factor.supernodes.size()); ++s)
        std::fill_n(result.begin() + factor.supernodes[s].first_column, factor.supernodes[s].width, s);
    return result;
}

/// Computes kColumns columns of a node's block from the supernodes of L that it replaces.
class BlockColumns {
public:
    explicit BlockColumns(const SupernodalFactor& factor)
        : factor_(factor), local_of_row_(factor.permutation.size())
    {
    }

    /// @param rows    below the node's diagonal block
    /// @param first   first column, in the block
    /// @param values  of the block
    void write(const InvertedNode& node, View<const Supernode> supernodes, const int* rows, int first,
               double* values)
    {
        for (int k = 0; k < node.width; ++k)
            local_of_row_[node.first_column + k] = k;
        for (int r = 0; r < node.row_count; ++r)
            local_of_row_[rows[r]] = node.width + r;
        const int count = std::min(kColumns, node.width - first);
        y_.assign(node.height(), Row{});
        for (int c = 0; c < count; ++c)
            y_[first + c].lanes[c / kLanes][c % kLanes] = 1.0;
        for (Supernode supernode : supernodes) {
            supernode.first_column -= node.first_column;
            if (supernode.first_column + supernode.width > first)
                forward(supernode);
        }
        for (int i = first; i < node.height(); ++i)
            for (int c = 0; c < count; ++c)
                values[std::size_t(i) * node.stride + first + c] = y_[i][c];
    }

private:
    void forward(const Supernode& supernode)
    {
        local_rows_.resize(supernode.row_count);
        for (int r = 0; r < supernode.row_count; ++r)
            local_rows_[r] = local_of_row_[factor_.rows[supernode.first_row + r]];
        forward_node(supernode, local_rows_.data(), factor_.values.data() + supernode.first_value, y_.data());
    }

    const SupernodalFactor& factor_;
    std::vector<int> local_of_row_; ///< [n] row in y_
    std::vector<int> local_rows_;
    std::vector<Row> y_; ///< [node's height]
};

} // namespace

InvertedFactor::InvertedFactor(const SupernodalFactor& factor)
    : permutation_(factor.permutation), node_of_column_(factor.permutation.size())
{
    const StageScope stage("linear/invert");
    merge(factor);
    connect();
    sort_into_levels();
    invert(factor);
}

/// Makes one node of every maximal subtree of at most kMergedColumns columns and of every supernode above
/// them.
void InvertedFactor::merge(const SupernodalFactor& factor)
{
    const int count = int(factor.supernodes.size());
    const std::vector<int> supernode_of_column = supernodes_of_columns(factor);
    std::vector<int> parent(count, -1), columns(count, 0), first(count);
    for (int s = 0; s < count; ++s)
        first[s] = s;
    for (int s = 0; s < count; ++s) {
        const Supernode& supernode = factor.supernodes[s];
        columns[s] += supernode.width;
        if (supernode.row_count == 0)
            continue;
        parent[s] = supernode_of_column[factor.rows[supernode.first_row]];
        columns[parent[s]] += columns[s];
        first[parent[s]] = std::min(first[parent[s]], first[s]);
    }

    // A subtree is a contiguous range that ends with its root, because the columns are in postorder.
    const auto is_small = [&](int s) { return columns[s] <= kMergedColumns; };
    for (int s = 0; s < count; ++s) {
        if (is_small(s) && parent[s] >= 0 && is_small(parent[s]))
            continue;
        const Supernode& root = factor.supernodes[s];
        InvertedNode node;
        const int first_supernode = is_small(s) ? first[s] : s;
        node.first_column = factor.supernodes[first_supernode].first_column;
        node.width = root.first_column + root.width - node.first_column;
        node.first_row = int(rows_.size());
        node.row_count = root.row_count;
        rows_.insert(rows_.end(), factor.rows.begin() + root.first_row,
                     factor.rows.begin() + root.first_row + root.row_count);
        std::fill_n(node_of_column_.begin() + node.first_column, node.width, int(nodes_.size()));
        first_supernode_.push_back(first_supernode);
        nodes_.push_back(node);
    }
    first_supernode_.push_back(count);
}

void InvertedFactor::connect()
{
    first_child_.assign(nodes_.size() + 1, 0);
    for (InvertedNode& node : nodes_)
        if (node.row_count > 0) {
            node.parent = node_of_column_[rows_[node.first_row]];
            ++first_child_[node.parent + 1];
        }
    for (size_t k = 1; k < first_child_.size(); ++k)
        first_child_[k] += first_child_[k - 1];
    children_.resize(first_child_.back());
    std::vector<int> next(first_child_.begin(), first_child_.end() - 1);
    for (int k = 0; k < int(nodes_.size()); ++k)
        if (nodes_[k].parent >= 0)
            children_[next[nodes_[k].parent]++] = k;
}

void InvertedFactor::sort_into_levels()
{
    level_of_.assign(nodes_.size(), 0);
    int levels = 0;
    for (int k = int(nodes_.size()) - 1; k >= 0; --k) {
        if (nodes_[k].parent >= 0)
            level_of_[k] = level_of_[nodes_[k].parent] + 1;
        levels = std::max(levels, level_of_[k] + 1);
    }
    first_of_level_.assign(levels + 1, 0);
    for (const int level : level_of_)
        ++first_of_level_[level + 1];
    for (int level = 0; level < levels; ++level)
        first_of_level_[level + 1] += first_of_level_[level];
    nodes_of_levels_.resize(nodes_.size());
    std::vector<int> next(first_of_level_.begin(), first_of_level_.end() - 1);
    for (int k = 0; k < int(nodes_.size()); ++k)
        nodes_of_levels_[next[level_of_[k]]++] = k;
}

void InvertedFactor::invert(const SupernodalFactor& factor)
{
    struct Part {
        int node, first_column;
    };
    std::vector<Part> parts;
    std::size_t entries = 0;
    for (int k = 0; k < int(nodes_.size()); ++k) {
        InvertedNode& node = nodes_[k];
        node.stride = rounded_up(node.width, 2);
        node.first_value = entries;
        entries += std::size_t(node.height()) * node.stride;
        for (int first = 0; first < node.width; first += kColumns)
            parts.push_back({k, first});
    }
    if (entries > std::size_t(std::numeric_limits<int>::max()))
        throw InvalidInput("the factor of a matrix of " + std::to_string(size()) + " rows has " +
                           std::to_string(entries) + " entries, 2^31 - 1 are the most");
    values_.assign(entries, 0.0);
    parallel_tasks_with(
        kCpu, "linear/invert_blocks", int(parts.size()), [&] { return BlockColumns(factor); },
        [&](int part, BlockColumns& columns) {
            const auto [k, first] = parts[part];
            const InvertedNode& node = nodes_[k];
            const View<const Supernode> supernodes(factor.supernodes);
            columns.write(
                node, supernodes.subview(first_supernode_[k], first_supernode_[k + 1] - first_supernode_[k]),
                rows_.data() + node.first_row, first, values_.data() + node.first_value);
        });
}

} // namespace toile
