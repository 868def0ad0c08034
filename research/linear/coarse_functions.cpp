#include "research/linear/coarse_functions.h"

#include <algorithm>
#include <limits>

namespace toile::research {

namespace {

constexpr int kUnreached = std::numeric_limits<int>::max();

/// Breadth-first search on the graph of A: calls visit(vertex, edges) in the order of distance from `start`
/// and continues from vertices for which it returns true. May visit a vertex several times.
template <typename Visit>
void walk(const SparseMatrix& A, int start, const Visit& visit)
{
    std::vector<int> front{start}, next;
    for (int edges = 0; !front.empty(); ++edges, front.swap(next), next.clear())
        for (const int i : front)
            if (visit(i, edges))
                for (SparseMatrix::InnerIterator entry(A, i); entry; ++entry)
                    if (entry.col() != i)
                        next.push_back(int(entry.col()));
}

struct Samples {
    std::vector<int> vertices;
    int radius = 0; ///< [edges] largest distance of a vertex from its closest sample
};

/// Farthest-point sampling; the lowest index wins among equally far vertices.
Samples farthest_points(const SparseMatrix& A, const std::vector<unsigned char>& is_open, int count)
{
    std::vector<int> distance(is_open.size());
    for (size_t i = 0; i < is_open.size(); ++i)
        distance[i] = is_open[i] ? kUnreached : 0;
    Samples samples;
    auto farthest = std::max_element(distance.begin(), distance.end());
    while (int(samples.vertices.size()) < count && farthest != distance.end() && *farthest > 0) {
        const int start = int(farthest - distance.begin());
        samples.vertices.push_back(start);
        walk(A, start, [&](int i, int edges) {
            const bool is_closer = edges < distance[i];
            distance[i] = std::min(distance[i], edges);
            return is_closer;
        });
        farthest = std::max_element(distance.begin(), distance.end());
    }
    for (const int edges : distance)
        samples.radius = edges == kUnreached ? samples.radius : std::max(samples.radius, edges);
    return samples;
}

} // namespace

SparseMatrix jacobi_smoothed(const SparseMatrix& A, const SparseMatrix& functions, double damping)
{
    SparseMatrix change = A * functions;
    for (int row = 0; row < int(A.rows()); ++row) {
        const double diagonal = A.coeff(row, row);
        for (SparseMatrix::InnerIterator entry(change, row); entry; ++entry)
            entry.valueRef() *= damping / diagonal;
    }
    return functions - change;
}

SparseMatrix partition_of_unity(const SparseMatrix& A, View<const double> inverse_diagonal, int count,
                                double overlap)
{
    const int n = int(A.rows());
    std::vector<unsigned char> is_open(n);
    for (int i = 0; i < n; ++i)
        is_open[i] = inverse_diagonal[i] > 0.0 && A.outerIndexPtr()[i + 1] - A.outerIndexPtr()[i] > 1;
    const Samples samples = farthest_points(A, is_open, count);

    // Bumps, one search per sample.
    const double reach = overlap * samples.radius + 1.0;
    Triplets entries;
    std::vector<double> sums(n, 0.0);
    std::vector<int> seen_from(n, -1);
    for (int s = 0; s < int(samples.vertices.size()); ++s)
        walk(A, samples.vertices[s], [&](int i, int edges) {
            if (seen_from[i] == s || !(edges < reach))
                return false;
            seen_from[i] = s;
            const double w = (1.0 - edges / reach) * (1.0 - edges / reach);
            entries.emplace_back(i, s, w);
            sums[i] += w;
            return true;
        });

    SparseMatrix P(n, int(samples.vertices.size()));
    P.setFromTriplets(entries.begin(), entries.end());
    for (int i = 0; i < n; ++i)
        for (SparseMatrix::InnerIterator entry(P, i); entry; ++entry)
            entry.valueRef() /= sums[i];
    return P;
}

} // namespace toile::research
