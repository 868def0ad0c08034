#include "core/linear/inverse_columns.h"

#include <algorithm>

namespace toile {

namespace {

using Row = InverseColumns::Row;

/// Rows of a product computed together: their accumulators fill half of the vector registers.
constexpr int kTile = 4;

/// y_node[k] -= sum_r L(r, k) y[rows[r]] for `Count` columns from `L` on, the rows of L `stride` apart.
template <int Count>
void subtract_transposed(const double* L, int stride, const int* rows, int row_count, const Row* y,
                         Row* y_node)
{
    std::array<Row, Count> sum{};
    for (int r = 0; r < row_count; ++r)
        for (int k = 0; k < Count; ++k)
            sum[k] += L[long(r) * stride + k] * y[rows[r]];
    for (int k = 0; k < Count; ++k)
        y_node[k] -= sum[k];
}

/// y[rows[k]] -= sum_j L(k, j) y_node[j] for `Count` rows of L of length `width`.
template <int Count>
void subtract(const double* L, int width, const int* rows, const Row* y_node, Row* y)
{
    std::array<Row, Count> sum{};
    for (int j = 0; j < width; ++j)
        for (int k = 0; k < Count; ++k)
            sum[k] += L[long(k) * width + j] * y_node[j];
    for (int k = 0; k < Count; ++k)
        y[rows[k]] -= sum[k];
}

void backward_node(const SupernodalFactor::Supernode& node, const int* rows, const double* L, Row* y)
{
    const int width = node.width;
    Row* y_node = y + node.first_column;
    const double* below = L + long(width) * width;
    int j = 0;
    for (; j + kTile <= width; j += kTile)
        subtract_transposed<kTile>(below + j, width, rows, node.row_count, y, y_node + j);
    for (; j < width; ++j)
        subtract_transposed<1>(below + j, width, rows, node.row_count, y, y_node + j);
    for (int i = width - 1; i >= 0; --i) {
        Row sum = y_node[i];
        for (int k = i + 1; k < width; ++k)
            sum -= L[long(k) * width + i] * y_node[k];
        y_node[i] = L[long(i) * width + i] * sum;
    }
}

} // namespace

void forward_node(const SupernodalFactor::Supernode& node, const int* rows, const double* L, Row* y)
{
    const int width = node.width;
    Row* y_node = y + node.first_column;
    for (int i = 0; i < width; ++i) {
        const double* row = L + long(i) * width;
        Row sum = y_node[i];
        for (int j = 0; j < i; ++j)
            sum -= row[j] * y_node[j];
        y_node[i] = row[i] * sum;
    }
    const double* below = L + long(width) * width;
    int r = 0;
    for (; r + kTile <= node.row_count; r += kTile)
        subtract<kTile>(below + long(r) * width, width, rows + r, y_node, y);
    for (; r < node.row_count; ++r)
        subtract<1>(below + long(r) * width, width, rows + r, y_node, y);
}

InverseColumns::InverseColumns(const SupernodalFactor& factor)
    : factor_(factor), row_of_(factor.permutation.size()), node_of_column_(factor.permutation.size())
{
    for (int k = 0; k < size(); ++k)
        row_of_[factor.permutation[k]] = k;
    for (int s = 0; s < int(factor.supernodes.size()); ++s)
        std::fill_n(node_of_column_.begin() + factor.supernodes[s].first_column, factor.supernodes[s].width,
                    s);
}

void InverseColumns::solve(View<const int> columns, Block& block) const
{
    TOILE_ASSERT(columns.size() <= kColumns);
    block.assign(size(), Row{});
    for (int c = 0; c < columns.size(); ++c)
        block[row_of_[columns[c]]].lanes[c / kLanes][c % kLanes] = 1.0;
    forward(columns, block);
    backward(block);
}

/// Solves L y = b on the supernodes that b reaches.
void InverseColumns::forward(View<const int> columns, Block& block) const
{
    thread_local std::vector<char> is_reached;
    is_reached.assign(factor_.supernodes.size(), 0);
    int first = int(factor_.supernodes.size());
    for (const int column : columns) {
        const int node = node_of_column_[row_of_[column]];
        is_reached[node] = 1;
        first = std::min(first, node);
    }
    for (int s = first; s < int(factor_.supernodes.size()); ++s) {
        if (!is_reached[s])
            continue;
        const SupernodalFactor::Supernode& node = factor_.supernodes[s];
        const int* rows = factor_.rows.data() + node.first_row;
        forward_node(node, rows, factor_.values.data() + node.first_value, block.data());
        for (int r = 0; r < node.row_count; ++r)
            is_reached[node_of_column_[rows[r]]] = 1;
    }
}

/// Solves L^T x = y.
void InverseColumns::backward(Block& block) const
{
    for (int s = int(factor_.supernodes.size()) - 1; s >= 0; --s) {
        const SupernodalFactor::Supernode& node = factor_.supernodes[s];
        backward_node(node, factor_.rows.data() + node.first_row, factor_.values.data() + node.first_value,
                      block.data());
    }
}

} // namespace toile
