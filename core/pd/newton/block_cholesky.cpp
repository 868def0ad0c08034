#include "core/pd/newton/block_cholesky.h"

#include <algorithm>
#include <set>

#include <Eigen/Cholesky>

#include "core/base/stages.h"

namespace toile {

BlockCholesky::BlockCholesky(const std::vector<std::vector<int>>& columns)
{
    first_entry_.push_back(0);
    for (const std::vector<int>& row : columns) {
        columns_.insert(columns_.end(), row.begin(), row.end());
        first_entry_.push_back(int(columns_.size()));
    }
    A_.assign(columns_.size(), Block::Zero());
    find_order(columns);
    L_.resize(below_.size());
    applied_.resize(below_.size());
    diagonal_.resize(rows());
    inverse_diagonal_.resize(rows());
    y_.resize(rows());
}

/// Eliminates the row with the fewest neighbours in turn, and connects those with each other. The smallest
/// number decides between equals.
void BlockCholesky::find_order(const std::vector<std::vector<int>>& columns)
{
    const int n = int(columns.size());
    std::vector<std::set<int>> neighbours(n);
    for (int i = 0; i < n; ++i)
        for (const int j : columns[i])
            if (j != i)
                neighbours[i].insert(j);
    std::set<std::pair<int, int>> queue; // (degree, row)
    for (int i = 0; i < n; ++i)
        queue.emplace(int(neighbours[i].size()), i);
    place_.resize(n);
    std::vector<std::vector<int>> below;
    while (!queue.empty()) {
        const int row = queue.begin()->second;
        queue.erase(queue.begin());
        place_[row] = int(order_.size());
        order_.push_back(row);
        for (const int i : neighbours[row]) {
            queue.erase({int(neighbours[i].size()), i});
            neighbours[i].erase(row);
            for (const int j : neighbours[row])
                if (j != i)
                    neighbours[i].insert(j);
            queue.emplace(int(neighbours[i].size()), i);
        }
        below.emplace_back(neighbours[row].begin(), neighbours[row].end());
    }
    first_below_.assign(1, 0);
    for (std::vector<int>& rows : below) {
        for (int& row : rows)
            row = place_[row];
        std::sort(rows.begin(), rows.end());
        below_.insert(below_.end(), rows.begin(), rows.end());
        first_below_.push_back(int(below_.size()));
    }
}

bool BlockCholesky::factor()
{
    const StageScope stage("linear/block_factor");
    std::fill(L_.begin(), L_.end(), Block::Zero());
    for (int row = 0; row < rows(); ++row)
        for (int e = first_entry_[row]; e < first_entry_[row + 1]; ++e) {
            const int i = place_[row], j = place_[columns_[e]];
            if (i == j)
                diagonal_[i] = A_[e];
            else if (i > j)
                L_[std::lower_bound(below_.begin() + first_below_[j], below_.begin() + first_below_[j + 1],
                                    i) -
                   below_.begin()] = A_[e];
        }
    for (int column = 0; column < rows(); ++column) {
        const Eigen::LLT<Block> llt(diagonal_[column]);
        if (llt.info() != Eigen::Success)
            return false;
        diagonal_[column] = llt.matrixL();
        inverse_diagonal_[column] =
            diagonal_[column].triangularView<Eigen::Lower>().solve(Block::Identity()).cast<float>();
        eliminate(column);
    }
    return true;
}

/// Scales a column of L and subtracts its products from the columns to the right.
void BlockCholesky::eliminate(int column)
{
    const int first = first_below_[column], last = first_below_[column + 1];
    const Block inverse = diagonal_[column].triangularView<Eigen::Lower>().solve(Block::Identity());
    for (int e = first; e < last; ++e) {
        const Block scaled = L_[e] * inverse.transpose();
        L_[e] = scaled;
        applied_[e] = scaled.cast<float>();
    }
    for (int e = first; e < last; ++e) {
        const int to = below_[e];
        diagonal_[to].noalias() -= L_[e] * L_[e].transpose();
        int target = first_below_[to];
        for (int f = e + 1; f < last; ++f) {
            while (below_[target] != below_[f])
                ++target;
            L_[target].noalias() -= L_[f] * L_[e].transpose();
        }
    }
}

void BlockCholesky::solve(View<Vector> x) const
{
    for (int place = 0; place < rows(); ++place)
        y_[place] = x[order_[place]];
    for (int column = 0; column < rows(); ++column) {
        const Vector solved = inverse_diagonal_[column] * y_[column];
        y_[column] = solved;
        for (int e = first_below_[column]; e < first_below_[column + 1]; ++e)
            y_[below_[e]].noalias() -= applied_[e] * solved;
    }
    for (int column = rows() - 1; column >= 0; --column) {
        Vector sum = y_[column];
        for (int e = first_below_[column]; e < first_below_[column + 1]; ++e)
            sum.noalias() -= applied_[e].transpose() * y_[below_[e]];
        y_[column] = inverse_diagonal_[column].transpose() * sum;
    }
    for (int place = 0; place < rows(); ++place)
        x[order_[place]] = y_[place];
}

} // namespace toile
