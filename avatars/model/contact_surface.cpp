#include "avatars/model/contact_surface.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/compute/parallel.h"

namespace toile::avatars {

namespace {

using Edge = std::array<int, 2>;

/// Directed edges of the triangles with mark `value`.
std::vector<Edge> edges_of(View<const Triangle> triangles, View<const unsigned char> mark,
                           unsigned char value)
{
    std::vector<Edge> edges;
    for (int t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3 && mark[t] == value; ++k)
            edges.push_back({triangles[t][k], triangles[t][(k + 1) % 3]});
    return edges;
}

/// Lowest vertex connected to each vertex by the edges. O(edges * lid diameter), for borders of some dozen
/// edges.
std::map<int, int> lowest_joined(const std::vector<Edge>& edges)
{
    std::map<int, int> lowest;
    for (const Edge& edge : edges)
        for (const int v : edge)
            lowest[v] = v;
    for (bool changes = true; changes;) {
        changes = false;
        for (const auto& [a, b] : edges) {
            const int low = std::min(lowest[a], lowest[b]);
            changes = changes || lowest[a] != low || lowest[b] != low;
            lowest[a] = lowest[b] = low;
        }
    }
    return lowest;
}

} // namespace

ContactSurface::ContactSurface(View<const Triangle> triangles, View<const unsigned char> excluded,
                               int vertex_count, const std::string& user)
    : body_vertices_(vertex_count)
{
    for (int t = 0; t < triangles.size(); ++t)
        if (excluded[t] == 0) {
            triangles_.push_back(triangles[t]);
            face_.push_back(t);
        }
    if (face_.empty())
        throw InvalidInput(user + ": leaves no face of the body for contact; name fewer bones, or remove the "
                                  "avatar");

    // Collect the edges between a remaining and an excluded face, which has the reverse edge.
    const std::vector<Edge> gone = edges_of(triangles, excluded, 1);
    const std::set<Edge> gone_edges(gone.begin(), gone.end());
    std::vector<Edge> border;
    for (const Edge& edge : edges_of(triangles, excluded, 0))
        if (gone_edges.contains({edge[1], edge[0]}))
            border.push_back(edge);
    close_holes(border);
}

/// Adds one fan per connected component of the border. Every border edge gets a face with the reverse edge,
/// so a closed surface is closed again for any shape of the border.
void ContactSurface::close_holes(const std::vector<Edge>& border)
{
    const std::map<int, int> lowest = lowest_joined(border);
    std::map<int, std::vector<int>> rim_of; // by its lowest vertex; ascending
    for (const auto& [v, low] : lowest)
        rim_of[low].push_back(v);
    std::map<int, int> lid_of;
    first_rim_.push_back(0);
    for (const auto& [low, rim] : rim_of) {
        lid_of.emplace(low, int(lid_of.size()));
        rims_.insert(rims_.end(), rim.begin(), rim.end());
        first_rim_.push_back(int(rims_.size()));
    }
    for (const auto& [a, b] : border)
        triangles_.emplace_back(b, a, body_vertices_ + lid_of.at(lowest.at(a)));
}

void ContactSurface::place_lids(View<Vec3> x) const
{
    TOILE_ASSERT(x.size() == vertex_count());
    const View<Vec3> middles = x.subview(body_vertices_, lids().count());
    parallel_for(kCpu, "avatars/lids", middles.size(),
                 PlaceLids{lids(), x.subview(0, body_vertices_), middles});
}

} // namespace toile::avatars
