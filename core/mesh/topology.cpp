#include "core/mesh/topology.h"

#include <algorithm>
#include <tuple>

#include "core/base/error.h"

namespace toile {

namespace {

/// One side of a triangle, with its end points in ascending order for matching.
struct HalfEdge {
    int low, high;
    int triangle, corner;
    bool ascending; ///< the triangle runs along it from low to high
};

std::string edge_name(const HalfEdge& half)
{
    return "edge (" + std::to_string(half.low) + ", " + std::to_string(half.high) + ")";
}

std::vector<HalfEdge> sorted_half_edges(View<const Triangle> triangles)
{
    std::vector<HalfEdge> halves;
    halves.reserve(3 * size_t(triangles.size()));
    for (int t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = triangles[t][k];
            const int b = triangles[t][(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
        }
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return halves;
}

} // namespace

bool Topology::is_closed() const
{
    return std::none_of(edges.begin(), edges.end(), [](const Edge& edge) { return edge.is_border(); });
}

Incidence corners_of_vertices(View<const Triangle> triangles, int vertex_count)
{
    Incidence incidence;
    incidence.first.assign(vertex_count + 1, 0);
    for (const Triangle& corner : triangles)
        for (const int v : corner)
            ++incidence.first[v + 1];
    for (int v = 0; v < vertex_count; ++v)
        incidence.first[v + 1] += incidence.first[v];

    incidence.items.resize(3 * size_t(triangles.size()));
    std::vector<int> next(incidence.first.begin(), incidence.first.end() - 1);
    for (int t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3; ++k)
            incidence.items[next[triangles[t][k]]++] = 3 * t + k;
    return incidence;
}

Topology build_topology(View<const Triangle> triangles, int vertex_count, const std::string& source)
{
    Topology topology;
    topology.corners_of_vertex = corners_of_vertices(triangles, vertex_count);
    topology.triangle_edge.resize(triangles.size());

    const std::vector<HalfEdge> halves = sorted_half_edges(triangles);
    for (size_t begin = 0; begin < halves.size();) {
        size_t end = begin + 1;
        while (end < halves.size() && halves[end].low == halves[begin].low &&
               halves[end].high == halves[begin].high)
            ++end;
        const HalfEdge& first = halves[begin];
        if (end - begin > 2)
            throw InvalidInput(source + ": " + edge_name(first) +
                               " is non-manifold: " + std::to_string(end - begin) +
                               " triangles share it, at most 2 may; split the surface there");
        if (end - begin == 2 && first.ascending == halves[begin + 1].ascending)
            throw InvalidInput(source + ": triangles " + std::to_string(first.triangle) + " and " +
                               std::to_string(halves[begin + 1].triangle) + " run " + edge_name(first) +
                               " in the same direction; flip one of them so that windings agree");

        Edge edge;
        edge.vertex = {triangles[first.triangle][first.corner],
                       triangles[first.triangle][(first.corner + 1) % 3]};
        for (size_t side = begin; side < end; ++side) {
            const HalfEdge& half = halves[side];
            edge.triangle[side - begin] = half.triangle;
            edge.opposite[side - begin] = triangles[half.triangle][(half.corner + 2) % 3];
            topology.triangle_edge[half.triangle][half.corner] = int(topology.edges.size());
        }
        topology.edges.push_back(edge);
        begin = end;
    }
    return topology;
}

} // namespace toile
