#include "core/linear/supernodal_factor.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile {

namespace {

using Vec4 = Eigen::Vector4d;

/// Rows or columns treated together: eight accumulators fill the registers and hide the latency of the
/// multiply-adds.
constexpr int kBlock = 8;

/// Max fraction of L's entries in one subtree. With a smaller one more threads find work, but more of L stays
/// above the subtrees, where one thread works alone.
constexpr double kLargestSubtree = 1.0 / 12.0;

/// Min number of entries of L for which a solve is split.
constexpr long kMinParallelEntries = 200'000;

/// acc[k] = sum_j L(k, j) y[j] for `Count` rows of length `width`, `stride` apart.
template <int Count>
void multiply_rows(const double* L, int stride, int width, const Vec4* y, Vec4* acc)
{
    Vec4 sum[Count];
    for (int k = 0; k < Count; ++k)
        sum[k].setZero();
    for (int j = 0; j < width; ++j)
        for (int k = 0; k < Count; ++k)
            sum[k] += L[long(k) * stride + j] * y[j];
    for (int k = 0; k < Count; ++k)
        acc[k] = sum[k];
}

/// acc[k] = sum_r L(r, k) y[r] for `Count` columns starting at L, rows `stride` apart.
template <int Count>
void multiply_columns(const double* L, int stride, int row_count, const Vec4* y, Vec4* acc)
{
    Vec4 sum[Count];
    for (int k = 0; k < Count; ++k)
        sum[k].setZero();
    for (int r = 0; r < row_count; ++r)
        for (int k = 0; k < Count; ++k)
            sum[k] += L[long(r) * stride + k] * y[r];
    for (int k = 0; k < Count; ++k)
        acc[k] = sum[k];
}

/// Solves L y = b on one supernode: the triangle first, then its update of the rows below.
void forward(const SupernodalFactor::Supernode& node, const int* rows, const double* L, Vec4* y)
{
    const int width = node.width;
    Vec4* y_node = y + node.first_column;
    for (int i = 0; i < width; ++i) {
        const double* row = L + long(i) * width;
        Vec4 sum = y_node[i];
        for (int j = 0; j < i; ++j)
            sum -= row[j] * y_node[j];
        y_node[i] = row[i] * sum;
    }

    const double* below = L + long(width) * width;
    Vec4 acc[kBlock];
    int r = 0;
    for (; r + kBlock <= node.row_count; r += kBlock) {
        multiply_rows<kBlock>(below + long(r) * width, width, width, y_node, acc);
        for (int k = 0; k < kBlock; ++k)
            y[rows[r + k]] -= acc[k];
    }
    for (; r < node.row_count; ++r) {
        multiply_rows<1>(below + long(r) * width, width, width, y_node, acc);
        y[rows[r]] -= acc[0];
    }
}

/// Solves L^T x = y on one supernode: the update from the rows below first, then the transposed triangle.
/// @param gathered  scratch for the values of the rows below [row_count]
void backward(const SupernodalFactor::Supernode& node, const int* rows, const double* L, Vec4* y,
              Vec4* gathered)
{
    const int width = node.width;
    Vec4* y_node = y + node.first_column;
    for (int r = 0; r < node.row_count; ++r)
        gathered[r] = y[rows[r]];

    const double* below = L + long(width) * width;
    Vec4 acc[kBlock];
    int j = 0;
    for (; j + kBlock <= width; j += kBlock) {
        multiply_columns<kBlock>(below + j, width, node.row_count, gathered, acc);
        for (int k = 0; k < kBlock; ++k)
            y_node[j + k] -= acc[k];
    }
    for (; j < width; ++j) {
        multiply_columns<1>(below + j, width, node.row_count, gathered, acc);
        y_node[j] -= acc[0];
    }

    for (int i = width - 1; i >= 0; --i) {
        Vec4 sum = y_node[i];
        for (int k = i + 1; k < width; ++k)
            sum -= L[long(k) * width + i] * y_node[k];
        y_node[i] = L[long(i) * width + i] * sum;
    }
}

/// Scratch of the calling thread, grown once: later solves allocate nothing.
Vec4* scratch(size_t count)
{
    thread_local std::vector<Vec4, Eigen::aligned_allocator<Vec4>> memory;
    if (memory.size() < count)
        memory.resize(count);
    return memory.data();
}

} // namespace

void SupernodalFactor::plan()
{
    max_rows_ = 0;
    for (const Supernode& node : supernodes)
        max_rows_ = std::max(max_rows_, node.row_count);
    split_tree();
    redirect_rows();
}

/// Splits subtrees at their roots until none holds more than the fraction kLargestSubtree of L.
void SupernodalFactor::split_tree()
{
    const int count = int(supernodes.size());
    std::vector<int> node_of_column(permutation.size());
    for (int s = 0; s < count; ++s)
        std::fill_n(node_of_column.begin() + supernodes[s].first_column, supernodes[s].width, s);

    // A subtree is a contiguous range that ends with its root, because the columns are in postorder.
    std::vector<int> first(count);
    std::vector<long> entries(count);
    std::vector<std::vector<int>> children(count);
    std::vector<int> open;
    for (int s = 0; s < count; ++s) {
        const Supernode& node = supernodes[s];
        entries[s] += long(node.width) * (node.width + node.row_count);
        TOILE_ASSERT(children[s].empty() || children[s].back() == s - 1);
        first[s] = children[s].empty() ? s : first[children[s].front()];
        if (node.row_count == 0) {
            open.push_back(s);
            continue;
        }
        const int parent = node_of_column[rows[node.first_row]];
        children[parent].push_back(s);
        entries[parent] += entries[s];
    }

    subtrees_.clear();
    top_.clear();
    const long total = long(values.size());
    while (!open.empty()) {
        const int root = open.back();
        open.pop_back();
        if (total < kMinParallelEntries || double(entries[root]) <= kLargestSubtree * double(total)) {
            subtrees_.push_back({first[root], root + 1});
            continue;
        }
        top_.push_back(root);
        open.insert(open.end(), children[root].begin(), children[root].end());
    }
    std::sort(top_.begin(), top_.end());
    std::sort(subtrees_.begin(), subtrees_.end(),
              [](const Subtree& a, const Subtree& b) { return a.first < b.first; });
}

/// Gives every subtree separate slots, behind the n columns, for its updates of the top's columns.
void SupernodalFactor::redirect_rows()
{
    top_columns_.clear();
    std::vector<int> slot(permutation.size(), -1);
    for (const int s : top_)
        for (int k = 0; k < supernodes[s].width; ++k) {
            slot[supernodes[s].first_column + k] = int(top_columns_.size());
            top_columns_.push_back(supernodes[s].first_column + k);
        }

    forward_rows_ = rows;
    const int n = int(permutation.size()), slots = int(top_columns_.size());
    for (int t = 0; t < int(subtrees_.size()); ++t)
        for (int s = subtrees_[t].first; s < subtrees_[t].last; ++s)
            for (int r = 0; r < supernodes[s].row_count; ++r)
                if (int& row = forward_rows_[supernodes[s].first_row + r]; slot[row] >= 0)
                    row = n + t * slots + slot[row];
}

void SupernodalFactor::solve(View<const Vec3> b, View<Vec3> x) const
{
    const int n = int(permutation.size());
    const int trees = int(subtrees_.size()), slots = int(top_columns_.size());
    Vec4* y = scratch(size_t(n) + size_t(trees) * slots + size_t(trees + 1) * max_rows_);
    Vec4* updates = y + n;
    Vec4* gathered = updates + size_t(trees) * slots;
    for (int k = 0; k < n; ++k)
        y[k] << b[permutation[k]], 0.0;
    std::fill(updates, updates + size_t(trees) * slots, Vec4::Zero());

    const auto forward_node = [&](int s) {
        const Supernode& node = supernodes[s];
        forward(node, forward_rows_.data() + node.first_row, values.data() + node.first_value, y);
    };
    const auto backward_node = [&](int s, Vec4* node_scratch) {
        const Supernode& node = supernodes[s];
        backward(node, rows.data() + node.first_row, values.data() + node.first_value, y, node_scratch);
    };
    parallel_tasks(kCpu, trees, [&](int t) {
        for (int s = subtrees_[t].first; s < subtrees_[t].last; ++s)
            forward_node(s);
    });
    for (int t = 0; t < trees; ++t)
        for (int k = 0; k < slots; ++k)
            y[top_columns_[k]] += updates[size_t(t) * slots + k];
    for (const int s : top_)
        forward_node(s);
    for (auto s = top_.rbegin(); s != top_.rend(); ++s)
        backward_node(*s, gathered + size_t(trees) * max_rows_);
    parallel_tasks(kCpu, trees, [&](int t) {
        for (int s = subtrees_[t].last - 1; s >= subtrees_[t].first; --s)
            backward_node(s, gathered + size_t(t) * max_rows_);
    });
    for (int k = 0; k < n; ++k)
        x[permutation[k]] = y[k].head<3>();
}

} // namespace toile
