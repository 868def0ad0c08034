#include "core/pd/newton/block_cholesky.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/base/stages.h"

namespace toile {

namespace {

template <int N>
using Square = Eigen::Matrix<double, N, N>;
template <int N>
using FloatSquare = Eigen::Matrix<float, N, N>;
template <int N>
using Column = Eigen::Matrix<float, N, 1>;

// Plain loops: the order of Eigen's sums depends on the alignment of the operands, and so on what was
// allocated before. Results would then differ from run to run.

/// C -= A B^T
template <int N>
void subtract_product(Square<N>& C, const Square<N>& A, const Square<N>& B)
{
    for (int j = 0; j < N; ++j)
        for (int k = 0; k < N; ++k)
            for (int i = 0; i < N; ++i)
                C(i, j) -= A(i, k) * B(j, k);
}

/// A B^T
template <int N>
Square<N> product_with_transposed(const Square<N>& A, const Square<N>& B)
{
    Square<N> C = Square<N>::Zero();
    for (int j = 0; j < N; ++j)
        for (int k = 0; k < N; ++k)
            for (int i = 0; i < N; ++i)
                C(i, j) += A(i, k) * B(j, k);
    return C;
}

/// Replaces the lower triangle of A by its Cholesky factor; zero above.
/// @return false if A is not positive definite
template <int N>
bool factor_in_place(Square<N>& A)
{
    for (int j = 0; j < N; ++j) {
        if (!(A(j, j) > 0.0))
            return false;
        const double diagonal = std::sqrt(A(j, j));
        for (int i = j; i < N; ++i)
            A(i, j) /= diagonal;
        for (int k = j + 1; k < N; ++k)
            for (int i = k; i < N; ++i)
                A(i, k) -= A(i, j) * A(k, j);
        for (int i = 0; i < j; ++i)
            A(i, j) = 0.0;
    }
    return true;
}

/// Inverse of a lower triangle.
template <int N>
Square<N> inverse_of_lower(const Square<N>& L)
{
    Square<N> inverse = Square<N>::Zero();
    for (int j = 0; j < N; ++j) {
        inverse(j, j) = 1.0 / L(j, j);
        for (int i = j + 1; i < N; ++i) {
            double sum = 0.0;
            for (int k = j; k < i; ++k)
                sum += L(i, k) * inverse(k, j);
            inverse(i, j) = -sum / L(i, i);
        }
    }
    return inverse;
}

/// y -= A x
template <int N>
void subtract_times(Column<N>& y, const FloatSquare<N>& A, const Column<N>& x)
{
    for (int k = 0; k < N; ++k)
        for (int i = 0; i < N; ++i)
            y[i] -= A(i, k) * x[k];
}

/// y -= A^T x
template <int N>
void subtract_transposed_times(Column<N>& y, const FloatSquare<N>& A, const Column<N>& x)
{
    for (int k = 0; k < N; ++k) {
        float sum = 0.0F;
        for (int i = 0; i < N; ++i)
            sum += A(i, k) * x[i];
        y[k] -= sum;
    }
}

} // namespace

template <int kSize>
BlockCholesky<kSize>::BlockCholesky(const std::vector<std::vector<int>>& columns)
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
template <int kSize>
void BlockCholesky<kSize>::find_order(const std::vector<std::vector<int>>& columns)
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

template <int kSize>
bool BlockCholesky<kSize>::factor()
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
        if (!factor_in_place(diagonal_[column]))
            return false;
        eliminate(column);
    }
    return true;
}

/// Scales a column of L and subtracts its products from the columns to the right.
template <int kSize>
void BlockCholesky<kSize>::eliminate(int column)
{
    const int first = first_below_[column], last = first_below_[column + 1];
    const Block inverse = inverse_of_lower(diagonal_[column]);
    inverse_diagonal_[column] = inverse.template cast<float>();
    for (int e = first; e < last; ++e) {
        L_[e] = product_with_transposed(L_[e], inverse);
        applied_[e] = L_[e].template cast<float>();
    }
    for (int e = first; e < last; ++e) {
        const int to = below_[e];
        subtract_product(diagonal_[to], L_[e], L_[e]);
        int target = first_below_[to];
        for (int f = e + 1; f < last; ++f) {
            while (below_[target] != below_[f])
                ++target;
            subtract_product(L_[target], L_[f], L_[e]);
        }
    }
}

template <int kSize>
void BlockCholesky<kSize>::solve(View<Vector> x) const
{
    for (int place = 0; place < rows(); ++place)
        y_[place] = x[order_[place]];
    for (int column = 0; column < rows(); ++column) {
        Vector solved = Vector::Zero();
        subtract_times(solved, inverse_diagonal_[column], y_[column]);
        y_[column] = -solved;
        for (int e = first_below_[column]; e < first_below_[column + 1]; ++e)
            subtract_times(y_[below_[e]], applied_[e], y_[column]);
    }
    for (int column = rows() - 1; column >= 0; --column) {
        Vector& sum = y_[column];
        for (int e = first_below_[column]; e < first_below_[column + 1]; ++e)
            subtract_transposed_times(sum, applied_[e], y_[below_[e]]);
        Vector solved = Vector::Zero();
        subtract_transposed_times(solved, inverse_diagonal_[column], sum);
        sum = -solved;
    }
    for (int place = 0; place < rows(); ++place)
        x[order_[place]] = y_[place];
}

template class BlockCholesky<9>;
template class BlockCholesky<12>;

} // namespace toile
