#include "volume/mesh/vertex_order.h"

#include <algorithm>
#include <numeric>

#include "core/pd/newton/connected_clusters.h"
#include "core/pd/newton/embedded_points.h"

namespace toile::volume {

namespace {

/// Number of tetrahedra at each vertex, which its number of neighbours follows.
std::vector<int> tets_of_vertices(const TetMesh& mesh)
{
    std::vector<int> count(mesh.positions.size(), 0);
    for (const Tet& tet : mesh.tets)
        for (const int v : tet)
            ++count[v];
    return count;
}

} // namespace

std::vector<int> vertex_order(const TetMesh& mesh)
{
    std::vector<int> all(mesh.positions.size());
    std::iota(all.begin(), all.end(), 0);
    const ClusterTree tree(embedded(mesh.positions), std::move(all), Extent::Volume);
    std::vector<int> order(tree.nodes().begin(), tree.nodes().end());
    order.resize(mesh.positions.size()); // the last leaf is padded
    const std::vector<int> tets = tets_of_vertices(mesh);
    constexpr size_t kSize = ConnectedClusters::kSize;
    for (size_t first = 0; first < order.size(); first += kSize)
        std::stable_sort(order.begin() + long(first),
                         order.begin() + long(std::min(first + kSize, order.size())),
                         [&](int a, int b) { return tets[a] < tets[b]; });
    return order;
}

void sort_by_vertex(std::vector<Tet>& tets)
{
    const auto smallest = [](const Tet& tet) { return *std::min_element(tet.begin(), tet.end()); };
    std::stable_sort(tets.begin(), tets.end(),
                     [&](const Tet& a, const Tet& b) { return smallest(a) < smallest(b); });
}

} // namespace toile::volume
