#include "core/mesh/topology.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "core/base/disjoint_sets.h"
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

bool is_collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

/// @param with_collapsed  take in triangles with two corners in one vertex
std::vector<HalfEdge> sorted_half_edges(View<const Triangle> triangles, bool with_collapsed = true)
{
    std::vector<HalfEdge> halves;
    halves.reserve(3 * size_t(triangles.size()));
    for (int t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3 && (with_collapsed || !is_collapsed(triangles[t])); ++k) {
            const int a = triangles[t][k];
            const int b = triangles[t][(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), t, k, a < b});
        }
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return halves;
}

/// Calls visit(begin, end) for the half edges of each edge.
template <typename Halves, typename Visit>
void for_each_edge(Halves& halves, const Visit& visit)
{
    for (auto begin = halves.begin(); begin != halves.end();) {
        auto end = begin + 1;
        while (end != halves.end() && end->low == begin->low && end->high == begin->high)
            ++end;
        visit(begin, end);
        begin = end;
    }
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
    for_each_edge(halves, [&](auto begin, auto end) {
        if (end - begin > 2)
            pair_at_branch(begin, end);
        const auto first_alone = end - begin > 2 ? begin + 2 : end;
        if (first_alone - begin == 2 && begin->ascending == (begin + 1)->ascending)
            refuse_directions(source, *begin, *(begin + 1));
        add_edge(begin, first_alone);
        for (auto half = first_alone; half != end; ++half)
            add_edge(half, half + 1);
    });
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

namespace {

/// Half edges across from each other; -1 at the border and at edges of three or more triangles.
/// [3 * triangle + corner]
std::vector<int> opposite_half_edges(const std::vector<HalfEdge>& halves, int triangle_count)
{
    std::vector<int> opposite(3 * size_t(triangle_count), -1);
    for_each_edge(halves, [&](auto begin, auto end) {
        if (end - begin != 2)
            return;
        const int a = 3 * begin->triangle + begin->corner;
        const int b = 3 * (begin + 1)->triangle + (begin + 1)->corner;
        opposite[a] = b;
        opposite[b] = a;
    });
    return opposite;
}

/// Border half edge that follows at a vertex: rotates about it from triangle to triangle. Orientations need
/// not agree.
int next_border(View<const Triangle> triangles, const std::vector<int>& opposite, int half, int vertex)
{
    for (;;) {
        // Of the two sides of the triangle at the vertex, take the other one.
        const int t = half / 3, k = half % 3;
        const int other = triangles[t][k] == vertex ? (k + 2) % 3 : (k + 1) % 3;
        half = 3 * t + other;
        if (opposite[half] < 0)
            return half;
        half = opposite[half];
    }
}

int count_border_loops(View<const Triangle> triangles, const std::vector<HalfEdge>& halves)
{
    const std::vector<int> opposite = opposite_half_edges(halves, triangles.size());
    std::vector<bool> is_done(opposite.size(), false);
    int loops = 0;
    for (const HalfEdge& first : halves) {
        int half = 3 * first.triangle + first.corner;
        if (opposite[half] >= 0 || is_done[half])
            continue;
        ++loops;
        int vertex = triangles[first.triangle][(first.corner + 1) % 3];
        while (!is_done[half]) {
            is_done[half] = true;
            half = next_border(triangles, opposite, half, vertex);
            const int low = triangles[half / 3][half % 3], high = triangles[half / 3][(half % 3 + 1) % 3];
            vertex = low == vertex ? high : low;
        }
    }
    return loops;
}

int count_pieces(const std::vector<HalfEdge>& halves, int triangle_count)
{
    DisjointSets sets(triangle_count);
    for_each_edge(halves, [&](auto begin, auto end) {
        for (auto half = begin + 1; half != end; ++half)
            sets.join(begin->triangle, half->triangle);
    });
    return int(std::count_if(halves.begin(), halves.end(), [&](const HalfEdge& half) {
        return half.corner == 0 && sets.find(half.triangle) == half.triangle;
    }));
}

int count_vertices(const std::vector<HalfEdge>& halves)
{
    std::vector<int> vertices;
    vertices.reserve(2 * halves.size());
    for (const HalfEdge& half : halves)
        vertices.insert(vertices.end(), {half.low, half.high});
    std::sort(vertices.begin(), vertices.end());
    return int(std::unique(vertices.begin(), vertices.end()) - vertices.begin());
}

std::vector<int> find_duplicates(View<const Triangle> triangles)
{
    std::vector<std::array<int, 4>> sorted;
    for (int t = 0; t < triangles.size(); ++t) {
        sorted.push_back({triangles[t][0], triangles[t][1], triangles[t][2], t});
        std::sort(sorted.back().begin(), sorted.back().begin() + 3);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<int> duplicates;
    for (size_t i = 1; i < sorted.size(); ++i)
        if (std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin()))
            duplicates.push_back(sorted[i][3]);
    std::sort(duplicates.begin(), duplicates.end());
    return duplicates;
}

} // namespace

SurfaceTopology surface_topology(View<const Triangle> triangles)
{
    const std::vector<HalfEdge> halves = sorted_half_edges(triangles, false);
    SurfaceTopology topology;
    int edges = 0;
    for_each_edge(halves, [&](auto begin, auto end) {
        ++edges;
        if (end - begin > 2)
            topology.non_manifold_edges.push_back({begin->low, begin->high});
    });
    for (int t = 0; t < triangles.size(); ++t)
        if (is_collapsed(triangles[t]))
            topology.collapsed_triangles.push_back(t);
    topology.duplicate_triangles = find_duplicates(triangles);
    topology.pieces = count_pieces(halves, triangles.size());
    topology.border_loops = count_border_loops(triangles, halves);
    topology.euler_characteristic = count_vertices(halves) - edges + int(halves.size() / 3);
    return topology;
}

} // namespace toile
