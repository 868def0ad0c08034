#include "research/linear/aggregation.h"

#include <algorithm>
#include <cmath>

namespace toile::research {

namespace {

constexpr int kFree = -1;

/// Fraction of a_ii below which weak entries are dropped instead of added to it [-]. Adding them would leave
/// a diagonal that no Jacobi step can divide by.
constexpr double kMinDiagonal = 0.1;

/// First pass: a vertex whose neighbours are all free founds a group with them.
void found_groups(const SparseMatrix& strong, Aggregation& groups)
{
    for (int i = 0; i < int(strong.rows()); ++i) {
        bool is_open = groups.group[i] == kFree;
        int neighbours = 0;
        for (SparseMatrix::InnerIterator entry(strong, i); entry && is_open; ++entry) {
            is_open = groups.group[entry.col()] == kFree;
            neighbours += entry.col() != i ? 1 : 0;
        }
        if (!is_open || neighbours == 0)
            continue;
        for (SparseMatrix::InnerIterator entry(strong, i); entry; ++entry)
            groups.group[entry.col()] = groups.count;
        ++groups.count;
    }
}

/// Second pass: each left-over vertex joins the group of the first pass to which it is coupled most strongly.
void join_groups(const SparseMatrix& strong, Aggregation& groups)
{
    const std::vector<int> founded = groups.group;
    for (int i = 0; i < int(strong.rows()); ++i) {
        double strongest = 0.0;
        if (founded[i] != kFree)
            continue;
        for (SparseMatrix::InnerIterator entry(strong, i); entry; ++entry)
            if (founded[entry.col()] != kFree && std::abs(entry.value()) > strongest) {
                strongest = std::abs(entry.value());
                groups.group[i] = founded[entry.col()];
            }
    }
}

/// Third pass: remaining vertices form groups with their free neighbours.
void gather_rest(const SparseMatrix& strong, Aggregation& groups)
{
    for (int i = 0; i < int(strong.rows()); ++i) {
        const int entries = strong.outerIndexPtr()[i + 1] - strong.outerIndexPtr()[i];
        if (groups.group[i] != kFree || entries <= 1)
            continue;
        for (SparseMatrix::InnerIterator entry(strong, i); entry; ++entry)
            if (groups.group[entry.col()] == kFree)
                groups.group[entry.col()] = groups.count;
        ++groups.count;
    }
}

} // namespace

SparseMatrix strong_part(const SparseMatrix& A, View<const double> inverse_diagonal, double strength)
{
    Triplets entries;
    for (int row = 0; row < int(A.rows()); ++row) {
        if (inverse_diagonal[row] == 0.0)
            continue;
        double diagonal = 0.0;
        const double full_diagonal = 1.0 / inverse_diagonal[row];
        for (SparseMatrix::InnerIterator entry(A, row); entry; ++entry) {
            const int column = int(entry.col());
            const double scale = inverse_diagonal[row] * inverse_diagonal[column];
            if (column == row || entry.value() * entry.value() * scale <= strength * strength)
                diagonal += entry.value();
            else
                entries.emplace_back(row, column, entry.value());
        }
        entries.emplace_back(row, row, diagonal > kMinDiagonal * full_diagonal ? diagonal : full_diagonal);
    }
    SparseMatrix strong(A.rows(), A.cols());
    strong.setFromTriplets(entries.begin(), entries.end());
    return strong;
}

Aggregation aggregate(const SparseMatrix& strong)
{
    Aggregation groups;
    groups.group.assign(strong.rows(), kFree);
    found_groups(strong, groups);
    join_groups(strong, groups);
    gather_rest(strong, groups);
    return groups;
}

SparseMatrix characteristic_functions(const Aggregation& groups)
{
    Triplets entries;
    for (int i = 0; i < int(groups.group.size()); ++i)
        if (groups.group[i] >= 0)
            entries.emplace_back(i, groups.group[i], 1.0);
    SparseMatrix functions(int(groups.group.size()), groups.count);
    functions.setFromTriplets(entries.begin(), entries.end());
    return functions;
}

} // namespace toile::research
