#include "volume/mesh/vertex_order.h"

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "tests/volume/blocks.h"

namespace toile::test {

using namespace volume;

namespace {

/// The same block with its vertices shuffled, as mesh generators leave them.
TetMesh shuffled_block()
{
    TetMesh mesh = make_block({1.0, 1.0, 1.0}, {12, 12, 12}).mesh;
    const int n = mesh.vertex_count(); // 13^3: coprime to the stride
    TetMesh shuffled = mesh;
    const auto number = [&](int v) { return int(long(v) * 1009 % n); };
    for (int v = 0; v < n; ++v)
        shuffled.positions[number(v)] = mesh.positions[v];
    for (Tet& tet : shuffled.tets)
        for (int& v : tet)
            v = number(v);
    return shuffled;
}

std::vector<std::set<int>> neighbours_of(const TetMesh& mesh)
{
    std::vector<std::set<int>> neighbours(mesh.positions.size());
    for (const Tet& tet : mesh.tets)
        for (const int v : tet)
            for (const int w : tet)
                if (v != w)
                    neighbours[v].insert(w);
    return neighbours;
}

/// Largest number of neighbours of each 32 vertices, on the mean: length of a padded row.
double padded_row(const std::vector<std::set<int>>& neighbours, const std::vector<int>& order)
{
    double sum = 0.0;
    int slices = 0;
    for (size_t first = 0; first + 32 <= order.size(); first += 32, ++slices) {
        size_t longest = 0;
        for (size_t k = first; k < first + 32; ++k)
            longest = std::max(longest, neighbours[order[k]].size());
        sum += double(longest);
    }
    return sum / slices;
}

TEST(VertexOrder, HasEveryVertexOnce)
{
    std::vector<int> order = vertex_order(shuffled_block());
    std::sort(order.begin(), order.end());
    std::vector<int> all(13 * 13 * 13);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_EQ(order, all);
}

TEST(VertexOrder, KeepsNeighboursTogether)
{
    const TetMesh mesh = shuffled_block();
    const std::vector<std::set<int>> neighbours = neighbours_of(mesh);
    const std::vector<int> order = vertex_order(mesh);
    // Of a cube of 64 vertices, 37 are inside of it or on a face of it; in any order but a local one, hardly
    // any neighbour is among the same 64.
    std::vector<int> place(order.size());
    for (size_t k = 0; k < order.size(); ++k)
        place[order[k]] = int(k);
    int together = 0, all = 0;
    for (size_t v = 0; v < neighbours.size(); ++v)
        for (const int w : neighbours[v]) {
            ++all;
            together += place[v] / 64 == place[w] / 64;
        }
    EXPECT_GT(together, all / 2);
}

TEST(VertexOrder, PadsRowsLess)
{
    const TetMesh mesh = shuffled_block();
    const std::vector<std::set<int>> neighbours = neighbours_of(mesh);
    std::vector<int> as_it_was(mesh.positions.size());
    std::iota(as_it_was.begin(), as_it_was.end(), 0);
    EXPECT_LT(padded_row(neighbours, vertex_order(mesh)), 0.9 * padded_row(neighbours, as_it_was));
}

TEST(VertexOrder, OfTetrahedraFollowsTheirSmallestVertex)
{
    TetMesh mesh = shuffled_block();
    std::multiset<Tet> before(mesh.tets.begin(), mesh.tets.end());
    sort_by_vertex(mesh.tets);
    EXPECT_EQ(std::multiset<Tet>(mesh.tets.begin(), mesh.tets.end()), before);
    for (size_t t = 1; t < mesh.tets.size(); ++t)
        EXPECT_LE(*std::min_element(mesh.tets[t - 1].begin(), mesh.tets[t - 1].end()),
                  *std::min_element(mesh.tets[t].begin(), mesh.tets[t].end()));
}

} // namespace

} // namespace toile::test
