#include "research/methods/colours.h"

#include <array>
#include <cmath>

#include "core/mesh/colouring.h"

namespace toile::research {

namespace {

/// Fraction of the row's diagonal below which entries of K are rounding of sums that cancel [-]. On regular
/// meshes these are the whole second ring. A larger value drops bending.
constexpr double kRoundingOfK = 1e-12;

} // namespace

std::vector<std::vector<Coupling>> couplings(const SparseMatrix& K)
{
    std::vector<std::vector<Coupling>> rows(K.outerSize());
    for (int row = 0; row < K.outerSize(); ++row) {
        const double min_value = kRoundingOfK * K.coeff(row, row);
        for (SparseMatrix::InnerIterator entry(K, row); entry; ++entry)
            if (entry.col() != row && std::abs(entry.value()) > min_value)
                rows[row].push_back({int(entry.col()), entry.value()});
    }
    return rows;
}

std::vector<std::vector<int>> colour_vertices(const garment::RestShape& rest, const SparseMatrix& K)
{
    // Collect pairs of vertices that share a term, as keys of both.
    std::vector<std::array<int, 2>> pairs;
    for (const Edge& edge : rest.topology.edges)
        pairs.push_back({edge.vertex[0], edge.vertex[1]});
    const std::vector<std::vector<Coupling>> rows = couplings(K);
    for (int row = 0; row < int(rows.size()); ++row)
        for (const Coupling& entry : rows[row])
            pairs.push_back({row, entry.vertex});

    Incidence keys;
    keys.first.assign(rest.vertex_count() + 1, 0);
    for (const auto& pair : pairs)
        for (const int v : pair)
            ++keys.first[v + 1];
    for (int v = 0; v < rest.vertex_count(); ++v)
        keys.first[v + 1] += keys.first[v];
    keys.items.resize(keys.first.back());
    std::vector<int> next(keys.first.begin(), keys.first.end() - 1);
    for (int p = 0; p < int(pairs.size()); ++p)
        for (const int v : pairs[p])
            keys.items[next[v]++] = p;
    return colour_items(keys, int(pairs.size()));
}

std::vector<std::vector<int>> colour_stencils(const std::vector<garment::Bending::Term>& terms,
                                              int vertex_count)
{
    Incidence vertices;
    vertices.first.push_back(0);
    for (const garment::Bending::Term& term : terms) {
        vertices.items.insert(vertices.items.end(), term.stencil.vertex.begin(), term.stencil.vertex.end());
        vertices.first.push_back(int(vertices.items.size()));
    }
    return colour_items(vertices, vertex_count);
}

} // namespace toile::research
