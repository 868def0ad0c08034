#include "collision/geometry/surface_edges.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace toile::collision {

std::vector<int> ranks_by_corners(View<const Triangle> triangles)
{
    const auto is_less = [&](int a, int b) {
        return std::lexicographical_compare(triangles[a].begin(), triangles[a].end(), triangles[b].begin(),
                                            triangles[b].end());
    };
    std::vector<int> order(triangles.size()), rank(triangles.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), is_less);
    for (size_t i = 1; i < order.size(); ++i)
        rank[order[i]] = rank[order[i - 1]] + int(is_less(order[i - 1], order[i]));
    return rank;
}

SurfaceEdges build_surface_edges(View<const Triangle> triangles, int vertex_count)
{
    // List the sides of all triangles, equal edges adjacent.
    struct Side {
        int low, high, triangle, corner;
    };
    std::vector<Side> sides;
    sides.reserve(3 * size_t(triangles.size()));
    for (int t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(triangles[t][k], triangles[t][(k + 1) % 3]);
            sides.push_back({low, high, t, k});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
    });

    // Start a new edge wherever the vertex pair changes.
    SurfaceEdges edges;
    edges.triangle_edge.resize(triangles.size());
    std::vector<int> balance; // per edge: sides in ascending direction minus descending
    for (const Side& side : sides) {
        const std::array<int, 2> pair{side.low, side.high};
        if (edges.vertex.empty() || edges.vertex.back() != pair) {
            edges.vertex.push_back(pair);
            edges.triangles.first.push_back(int(edges.triangles.items.size()));
            balance.push_back(0);
        }
        balance.back() += triangles[side.triangle][side.corner] == side.low ? 1 : -1;
        edges.triangles.items.push_back(side.triangle);
        edges.triangle_edge[side.triangle][side.corner] = edges.edge_count() - 1;
    }
    edges.triangles.first.push_back(int(edges.triangles.items.size()));
    edges.is_closed =
        !balance.empty() && std::all_of(balance.begin(), balance.end(), [](int both) { return both == 0; });
    edges.corners_of_vertex = corners_of_vertices(triangles, vertex_count);
    return edges;
}

} // namespace toile::collision
