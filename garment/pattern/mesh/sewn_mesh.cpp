#include "garment/pattern/mesh/sewn_mesh.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace toile::garment {

namespace {

/// Sets of joined items. The lowest member stands for a set.
class DisjointSets {
public:
    explicit DisjointSets(int count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    int find(int i)
    {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    bool join(int a, int b)
    {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }
    int count()
    {
        int result = 0;
        for (int i = 0; i < int(parent_.size()); ++i)
            result += find(i) == i;
        return result;
    }

private:
    std::vector<int> parent_;
};

/// Sides of panels to each other: which ones must be turned so that seams join front to front.
class PanelSides {
public:
    explicit PanelSides(int panels) : parent_(panels), turned_(panels, false)
    {
        std::iota(parent_.begin(), parent_.end(), 0);
    }

    /// @param is_against  one of both must be turned against the other
    /// @return false if they are joined already, the other way round
    bool join(int a, int b, bool is_against)
    {
        const auto [root_a, turned_a] = find(a);
        const auto [root_b, turned_b] = find(b);
        const bool turned = turned_a ^ turned_b ^ is_against;
        if (root_a == root_b)
            return !turned;
        parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
        turned_[std::max(root_a, root_b)] = turned;
        return true;
    }

    bool is_turned(int panel) const { return find(panel).second; }

private:
    std::pair<int, bool> find(int panel) const
    {
        bool turned = false;
        for (; parent_[panel] != panel; panel = parent_[panel])
            turned = turned != turned_[panel];
        return {panel, turned};
    }

    std::vector<int> parent_;
    std::vector<bool> turned_; ///< against the parent
};

/// Side of a triangle between welded vertices, in ascending order for matching.
struct HalfEdge {
    int low = 0, high = 0;
    int triangle = 0, corner = 0;

    bool matches(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sorted_half_edges(const std::vector<Triangle>& triangles)
{
    std::vector<HalfEdge> halves;
    halves.reserve(3 * triangles.size());
    for (int t = 0; t < int(triangles.size()); ++t)
        for (int k = 0; k < 3; ++k) {
            const int a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            halves.push_back({std::min(a, b), std::max(a, b), t, k});
        }
    std::sort(halves.begin(), halves.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
    });
    return halves;
}

/// Calls visit(begin, end) for the half edges of each edge.
template <typename Visit>
void for_each_edge(const std::vector<HalfEdge>& halves, const Visit& visit)
{
    for (auto begin = halves.begin(); begin != halves.end();) {
        auto end = begin + 1;
        while (end != halves.end() && end->matches(*begin))
            ++end;
        visit(begin, end);
        begin = end;
    }
}

/// Directions of all outline edges by their vertices: [outline vertices] next one along the loop, or -1.
std::vector<int> next_on_outline(const PatternMesh& mesh)
{
    std::vector<int> next(mesh.vertex_count(), -1);
    for (const auto& panel : mesh.edge_vertices)
        for (const auto& edge : panel)
            for (size_t i = 0; i + 1 < edge.size(); ++i)
                next[edge[i].vertex] = edge[i + 1].vertex;
    return next;
}

/// Stretch of a seam between two consecutive stitches that is an edge of both panels.
struct SewnEdge {
    int seam = 0;
    int panel_a = 0, panel_b = 0;
    bool is_against = false; ///< both run the same way along their loops: one has to be turned
};

std::vector<SewnEdge> sewn_edges(const PatternMesh& mesh)
{
    const std::vector<int> next = next_on_outline(mesh);
    const auto direction = [&](int from, int to) { return next[from] == to ? 1 : next[to] == from ? -1 : 0; };
    std::vector<SewnEdge> edges;
    for (int s = 0; s < int(mesh.stitches.size()); ++s)
        for (size_t i = 0; i + 1 < mesh.stitches[s].size(); ++i) {
            const auto &low = mesh.stitches[s][i], &high = mesh.stitches[s][i + 1];
            const int a = direction(low[0], high[0]), b = direction(low[1], high[1]);
            if (a != 0 && b != 0)
                edges.push_back({s, mesh.panel_of_vertex(low[0]), mesh.panel_of_vertex(low[1]), a == b});
        }
    return edges;
}

/// Turns panels against each other along seams that need it. Seams that join front to front go first, so that
/// the one to blame for a one-sided surface is one that does not.
void turn_panels(const PatternMesh& mesh, SewnMesh& sewn)
{
    PanelSides sides(mesh.panel_count());
    const std::vector<SewnEdge> edges = sewn_edges(mesh);
    for (const bool is_against : {false, true})
        for (const SewnEdge& edge : edges)
            if (edge.is_against == is_against && !sides.join(edge.panel_a, edge.panel_b, is_against) &&
                !sewn.topology.one_sided_seam)
                sewn.topology.one_sided_seam = edge.seam;
    for (int p = 0; p < mesh.panel_count(); ++p)
        sewn.is_turned.push_back(sides.is_turned(p));
}

void weld_triangles(const PatternMesh& mesh, SewnMesh& sewn)
{
    for (int t = 0; t < mesh.triangle_count(); ++t) {
        Triangle corners = mesh.triangles[t];
        if (sewn.is_turned[mesh.panel_of_triangle(t)])
            std::swap(corners[1], corners[2]);
        sewn.corners.push_back(corners);
        sewn.triangles.emplace_back(sewn.welded_of[corners[0]], sewn.welded_of[corners[1]],
                                    sewn.welded_of[corners[2]]);
    }
}

/// Half edges across from each other; -1 at the border and at edges of three or more triangles.
/// [3 * triangle + corner]
std::vector<int> opposite_half_edges(const std::vector<HalfEdge>& halves, size_t triangles)
{
    std::vector<int> opposite(3 * triangles, -1);
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
int next_border(const std::vector<Triangle>& triangles, const std::vector<int>& opposite, int half,
                int vertex)
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

int count_border_loops(const std::vector<Triangle>& triangles, const std::vector<int>& opposite)
{
    std::vector<bool> is_done(opposite.size(), false);
    int loops = 0;
    for (int start = 0; start < int(opposite.size()); ++start) {
        if (opposite[start] >= 0 || is_done[start])
            continue;
        ++loops;
        int half = start, vertex = triangles[start / 3][(start % 3 + 1) % 3];
        while (!is_done[half]) {
            is_done[half] = true;
            half = next_border(triangles, opposite, half, vertex);
            const int low = triangles[half / 3][half % 3], high = triangles[half / 3][(half % 3 + 1) % 3];
            vertex = low == vertex ? high : low;
        }
    }
    return loops;
}

int count_pieces(const std::vector<int>& opposite)
{
    DisjointSets sets(int(opposite.size()) / 3);
    for (int half = 0; half < int(opposite.size()); ++half)
        if (opposite[half] >= 0)
            sets.join(half / 3, opposite[half] / 3);
    return sets.count();
}

void find_bad_triangles(const std::vector<Triangle>& triangles, SewnTopology& topology)
{
    std::vector<std::array<int, 4>> sorted;
    for (int t = 0; t < int(triangles.size()); ++t) {
        std::array<int, 3> c{triangles[t][0], triangles[t][1], triangles[t][2]};
        std::sort(c.begin(), c.end());
        if (c[0] == c[1] || c[1] == c[2])
            topology.collapsed_triangles.push_back(t);
        sorted.push_back({c[0], c[1], c[2], t});
    }
    std::sort(sorted.begin(), sorted.end());
    for (size_t i = 1; i < sorted.size(); ++i)
        if (std::equal(sorted[i].begin(), sorted[i].begin() + 3, sorted[i - 1].begin()))
            topology.duplicate_triangles.push_back(sorted[i][3]);
    std::sort(topology.duplicate_triangles.begin(), topology.duplicate_triangles.end());
}

void measure_topology(SewnMesh& sewn)
{
    const std::vector<HalfEdge> halves = sorted_half_edges(sewn.triangles);
    SewnTopology& topology = sewn.topology;
    int edges = 0;
    for_each_edge(halves, [&](auto begin, auto end) {
        ++edges;
        if (end - begin > 2)
            topology.non_manifold_edges.push_back({begin->low, begin->high});
    });
    find_bad_triangles(sewn.triangles, topology);
    const std::vector<int> opposite = opposite_half_edges(halves, sewn.triangles.size());
    topology.pieces = count_pieces(opposite);
    topology.border_loops = count_border_loops(sewn.triangles, opposite);
    topology.euler_characteristic = sewn.vertex_count - edges + int(sewn.triangles.size());
}

} // namespace

std::vector<int> weld_stitches(const PatternMesh& mesh)
{
    DisjointSets sets(mesh.vertex_count());
    for (const auto& seam : mesh.stitches)
        for (const auto& [a, b] : seam)
            sets.join(a, b);
    std::vector<int> welded(mesh.vertex_count());
    int count = 0;
    for (int v = 0; v < mesh.vertex_count(); ++v)
        welded[v] = sets.find(v) == v ? count++ : welded[sets.find(v)];
    return welded;
}

SewnMesh sewn_mesh(const PatternMesh& mesh)
{
    SewnMesh sewn;
    sewn.welded_of = weld_stitches(mesh);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
        sewn.vertex_count = std::max(sewn.vertex_count, sewn.welded_of[v] + 1);
        sewn.members.resize(sewn.vertex_count);
        sewn.members[sewn.welded_of[v]].push_back(v);
    }
    turn_panels(mesh, sewn);
    weld_triangles(mesh, sewn);
    measure_topology(sewn);
    return sewn;
}

std::vector<std::array<int, 2>> edges_to_split(const PatternMesh& mesh)
{
    const std::vector<int> welded = weld_stitches(mesh);
    const std::vector<int> next = next_on_outline(mesh);

    // Edges by their welded ends; those of the outline first, which stay.
    using Ends = std::array<int, 2>;
    std::vector<std::tuple<Ends, bool, Ends>> edges; // welded ends, is inside, ends
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax({t[k], t[(k + 1) % 3]});
            const auto [low, high] = std::minmax({welded[a], welded[b]});
            const bool is_outline = next[a] == b || next[b] == a;
            edges.push_back({{low, high}, !is_outline, {a, b}});
        }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());

    std::vector<Ends> result;
    Ends before{-1, -1};
    for (const auto& [ends, is_inside, own_ends] : edges) {
        if (is_inside && (ends == before || ends[0] == ends[1]))
            result.push_back(own_ends);
        before = ends;
    }
    return result;
}

} // namespace toile::garment
