#include "scenes/contact_surface.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/backend/error.h"

namespace toile {

namespace {

using Edge = std::array<int, 2>;

/// The directed edges of the triangles that are marked with `value`.
std::vector<Edge> edges_of(View<const Triangle> triangles, View<const unsigned char> mark,
                           unsigned char value)
{
    std::vector<Edge> edges;
    for (int t = 0; t < triangles.size(); ++t)
        for (int k = 0; k < 3 && mark[t] == value; ++k)
            edges.push_back({triangles[t][k], triangles[t][(k + 1) % 3]});
    return edges;
}

/// The lowest vertex that each vertex of the edges is joined to by them. O(edges * lid diameter), for borders
/// of some dozen edges.
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
{
    for (int t = 0; t < triangles.size(); ++t)
        if (excluded[t] == 0) {
            mesh_.triangles.push_back(triangles[t]);
            face_.push_back(t);
        }
    if (face_.empty())
        throw InvalidInput(user + ": leaves no face of the body for contact; name fewer bones, or remove the "
                                  "avatar");

    // Where a remaining face meets one that is left out, which runs through the edge the other way.
    const std::vector<Edge> gone = edges_of(triangles, excluded, 1);
    const std::set<Edge> gone_edges(gone.begin(), gone.end());
    std::vector<Edge> border;
    for (const Edge& edge : edges_of(triangles, excluded, 0))
        if (gone_edges.contains({edge[1], edge[0]}))
            border.push_back(edge);
    close_holes(border, vertex_count);
}

/// One fan per connected piece of the border. Every border edge gets a face that runs through it the other
/// way, so what was closed is closed again, whatever shape the border has.
void ContactSurface::close_holes(const std::vector<Edge>& border, int vertex_count)
{
    const std::map<int, int> lowest = lowest_joined(border);
    std::map<int, int> lid_of; // by its lowest vertex
    for (const auto& [v, low] : lowest) {
        const auto [lid, is_new] = lid_of.emplace(low, int(rims_.size()));
        if (is_new)
            rims_.emplace_back();
        rims_[size_t(lid->second)].push_back(v);
    }
    for (const auto& [a, b] : border)
        mesh_.triangles.emplace_back(b, a, vertex_count + lid_of.at(lowest.at(a)));
    mesh_.positions.resize(size_t(vertex_count) + rims_.size());
}

void ContactSurface::move(View<const Vec3> x)
{
    auto middle = std::copy(x.begin(), x.end(), mesh_.positions.begin());
    for (const std::vector<int>& rim : rims_) {
        Vec3 sum = Vec3::Zero();
        for (const int v : rim)
            sum += x[v];
        *middle++ = sum / double(rim.size());
    }
}

} // namespace toile
