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

namespace {

[[noreturn]] void refuse_directions(const std::string& source, const HalfEdge& a, const HalfEdge& b)
{
    throw InvalidInput(source + ": triangles " + std::to_string(a.triangle) + " and " +
                       std::to_string(b.triangle) + " run " + edge_name(a) +
                       " in the same direction; flip one of them so that windings agree");
}

/// @param pair_at_branch  moves two of three or more half edges, which continue each other, to the front
template <typename PairAtBranch>
Topology build(View<const Triangle> triangles, int vertex_count, const std::string& source,
               const PairAtBranch& pair_at_branch)
{
    Topology topology;
    topology.corners_of_vertex = corners_of_vertices(triangles, vertex_count);
    topology.triangle_edge.resize(triangles.size());
    const auto add_edge = [&](auto begin, auto end) {
        Edge edge;
        edge.vertex = {triangles[begin->triangle][begin->corner],
                       triangles[begin->triangle][(begin->corner + 1) % 3]};
        for (auto half = begin; half != end; ++half) {
            edge.triangle[half - begin] = half->triangle;
            edge.opposite[half - begin] = triangles[half->triangle][(half->corner + 2) % 3];
            topology.triangle_edge[half->triangle][half->corner] = int(topology.edges.size());
        }
        topology.edges.push_back(edge);
    };

    std::vector<HalfEdge> halves = sorted_half_edges(triangles);
    for (auto begin = halves.begin(); begin != halves.end();) {
        auto end = begin + 1;
        while (end != halves.end() && end->low == begin->low && end->high == begin->high)
            ++end;
        if (end - begin > 2)
            pair_at_branch(begin, end);
        const auto first_alone = end - begin > 2 ? begin + 2 : end;
        if (first_alone - begin == 2 && begin->ascending == (begin + 1)->ascending)
            refuse_directions(source, *begin, *(begin + 1));
        add_edge(begin, first_alone);
        for (auto half = first_alone; half != end; ++half)
            add_edge(half, half + 1);
        begin = end;
    }
    return topology;
}

} // namespace

Topology build_topology(View<const Triangle> triangles, int vertex_count, const std::string& source)
{
    return build(triangles, vertex_count, source, [&](auto begin, auto end) {
        throw InvalidInput(source + ": " + edge_name(*begin) +
                           " is non-manifold: " + std::to_string(end - begin) +
                           " triangles share it, at most 2 may; split the surface there");
    });
}

Topology build_branching_topology(const TriangleMesh& mesh, const std::string& source)
{
    // Direction from the edge into the triangle, perpendicular to the edge.
    const auto inward = [&](const HalfEdge& half) {
        const Vec3& low = mesh.positions[half.low];
        const Vec3 along = (mesh.positions[half.high] - low).normalized();
        const Vec3 side = mesh.positions[mesh.triangles[half.triangle][(half.corner + 2) % 3]] - low;
        return Vec3((side - side.dot(along) * along).normalized());
    };
    return build(mesh.triangles, mesh.vertex_count(), source, [&](auto begin, auto end) {
        double flattest = 2.0;
        auto first = begin, second = begin + 1;
        for (auto a = begin; a != end; ++a)
            for (auto b = a + 1; b != end; ++b)
                if (const double cosine = inward(*a).dot(inward(*b));
                    a->ascending != b->ascending && cosine < flattest) {
                    flattest = cosine;
                    first = a;
                    second = b;
                }
        std::iter_swap(begin, first);
        std::iter_swap(begin + 1, second);
    });
}

} // namespace toile
