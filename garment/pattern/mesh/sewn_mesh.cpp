#include "garment/pattern/mesh/sewn_mesh.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <tuple>

#include "core/base/disjoint_sets.h"

namespace toile::garment {

namespace {

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

/// Edges of the welded mesh along seams on lines inside of panels.
std::set<std::array<int, 2>> inner_seam_edges(const PatternMesh& mesh, const std::vector<int>& welded_of)
{
    std::set<std::array<int, 2>> edges;
    for (size_t s = 0; s < mesh.stitches.size(); ++s)
        for (size_t i = 0; mesh.is_inner_seam[s] && i + 1 < mesh.stitches[s].size(); ++i) {
            const auto [low, high] =
                std::minmax({welded_of[mesh.stitches[s][i][0]], welded_of[mesh.stitches[s][i + 1][0]]});
            edges.insert({low, high});
        }
    return edges;
}

/// Surface topology in which seams on lines inside of panels open no border, and the edges of three triangles
/// along them are none of its mistakes.
SurfaceTopology topology_of(const PatternMesh& mesh, const SewnMesh& sewn)
{
    SurfaceTopology topology = surface_topology(sewn.triangles);
    if (std::find(mesh.is_inner_seam.begin(), mesh.is_inner_seam.end(), true) == mesh.is_inner_seam.end())
        return topology;
    PatternMesh apart = mesh;
    for (size_t s = 0; s < apart.stitches.size(); ++s)
        if (mesh.is_inner_seam[s])
            apart.stitches[s].clear();
    const std::vector<int> number = weld_stitches(apart);
    std::vector<Triangle> triangles = mesh.triangles;
    for (Triangle& t : triangles)
        t = Triangle(number[t[0]], number[t[1]], number[t[2]]);
    topology.border_loops = surface_topology(triangles).border_loops;
    const std::set<std::array<int, 2>> inner = inner_seam_edges(mesh, sewn.welded_of);
    std::erase_if(topology.non_manifold_edges, [&](const std::array<int, 2>& edge) {
        const auto [low, high] = std::minmax(edge[0], edge[1]);
        return inner.contains({low, high});
    });
    return topology;
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
    static_cast<SurfaceTopology&>(sewn.topology) = topology_of(mesh, sewn);
    return sewn;
}

std::vector<std::array<int, 2>> edges_to_split(const PatternMesh& mesh)
{
    const std::vector<int> welded = weld_stitches(mesh);
    const std::vector<int> next = next_on_outline(mesh);

    using Ends = std::array<int, 2>;
    std::set<Ends> on_lines;
    for (const auto& panel : mesh.panel_lines)
        for (const auto& line : panel)
            for (size_t i = 0; i + 1 < line.size(); ++i)
                on_lines.insert({std::min(line[i].vertex, line[i + 1].vertex),
                                 std::max(line[i].vertex, line[i + 1].vertex)});

    // Edges by their welded ends; those of outlines and lines first, which stay.
    std::vector<std::tuple<Ends, bool, Ends>> edges; // welded ends, is inside, ends
    for (const Triangle& t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const auto [a, b] = std::minmax({t[k], t[(k + 1) % 3]});
            const auto [low, high] = std::minmax({welded[a], welded[b]});
            const bool is_outline = next[a] == b || next[b] == a || on_lines.contains({a, b});
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
