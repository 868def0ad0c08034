#include "avatars/model/skinned_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "core/base/error.h"
#include "core/mesh/weld.h"

namespace toile::avatars {

namespace {

using VertexPair = std::pair<int, int>;

/// All edges of all triangles, smaller vertex first, sorted; an edge appears once per triangle.
std::vector<VertexPair> sorted_edges(const std::vector<Triangle>& triangles)
{
    std::vector<VertexPair> edges;
    edges.reserve(3 * triangles.size());
    for (const Triangle& t : triangles)
        for (int k = 0; k < 3; ++k)
            edges.push_back(std::minmax({t[k], t[(k + 1) % 3]}));
    std::sort(edges.begin(), edges.end());
    return edges;
}

/// Marks the end points of edges whose number of triangles satisfies the condition.
template <typename Condition>
std::vector<char> mark_edge_ends(const std::vector<Triangle>& triangles, int vertex_count,
                                 Condition condition)
{
    std::vector<char> marked(vertex_count, 0);
    const std::vector<VertexPair> edges = sorted_edges(triangles);
    for (size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end] == edges[i])
            ++end;
        if (condition(end - i))
            marked[edges[i].first] = marked[edges[i].second] = 1;
    }
    return marked;
}

std::vector<Triangle> renumbered(const std::vector<Triangle>& triangles, const std::vector<int>& new_of)
{
    std::vector<Triangle> result;
    for (const Triangle& t : triangles) {
        const Triangle moved(new_of[t[0]], new_of[t[1]], new_of[t[2]]);
        if (has_three_corners(moved))
            result.push_back(moved);
    }
    return result;
}

/// Lowest vertex coincident with each vertex; a vertex that is not `joinable` is its own leader.
std::vector<int> leaders(const SkinnedMesh& mesh, const std::vector<char>& joinable, double distance)
{
    std::vector<int> leader(mesh.rest.vertex_count());
    std::iota(leader.begin(), leader.end(), 0);
    std::map<int, std::vector<int>> vertices_of_space;
    for (int v = 0; v < mesh.rest.vertex_count(); ++v)
        if (joinable[v])
            vertices_of_space[mesh.space_of_vertex[v]].push_back(v);
    for (const auto& [space, vertex_of] : vertices_of_space) {
        TriangleMesh seam;
        for (const int v : vertex_of)
            seam.positions.push_back(mesh.rest.positions[v]);
        const Welded welded = weld(seam, distance);
        for (size_t i = 0; i < vertex_of.size(); ++i)
            leader[vertex_of[i]] = vertex_of[welded.source_of[welded.welded_of[i]]];
    }
    return leader;
}

/// Mean of the members' weights: influences of one bone added up, divided by the member count.
std::vector<Influence> mean_influences(const SkinnedMesh& mesh, const std::vector<int>& members)
{
    std::vector<Influence> mean;
    for (const int v : members)
        for (int k = mesh.first[v]; k < mesh.first[v + 1]; ++k) {
            const Influence& part = mesh.influences[k];
            const auto known = std::find_if(mean.begin(), mean.end(),
                                            [&](const Influence& i) { return i.bone == part.bone; });
            if (known == mean.end())
                mean.push_back({part.bone, part.weight / double(members.size())});
            else
                known->weight += part.weight / double(members.size());
        }
    std::stable_sort(mean.begin(), mean.end(),
                     [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
    return mean;
}

/// Gives every group of vertices the mean of its members' displacements by each shape.
void join_offsets(const SkinnedMesh& mesh, const std::vector<std::vector<int>>& groups, SkinnedMesh& result)
{
    result.first_offset = {0};
    for (const std::vector<int>& members : groups) {
        std::map<int, Vec3> sum_of;
        for (const int v : members)
            for (int k = mesh.first_offset[v]; k < mesh.first_offset[v + 1]; ++k)
                sum_of.try_emplace(mesh.offsets[k].shape, Vec3::Zero()).first->second +=
                    mesh.offsets[k].offset;
        for (const auto& [shape, sum] : sum_of)
            result.offsets.push_back({shape, sum / double(members.size())});
        result.first_offset.push_back(int(result.offsets.size()));
    }
}

/// The mesh with every vertex replaced by its leader.
/// @param new_of  [old vertices] out: their new indices
SkinnedMesh joined(const SkinnedMesh& mesh, const std::vector<int>& leader, std::vector<int>& new_of)
{
    new_of.resize(leader.size());
    std::vector<std::vector<int>> members;
    for (size_t v = 0; v < leader.size(); ++v) {
        if (leader[v] == int(v)) {
            new_of[v] = int(members.size());
            members.emplace_back();
        }
        new_of[v] = new_of[leader[v]];
        members[new_of[v]].push_back(int(v));
    }

    SkinnedMesh result;
    result.bones = mesh.bones;
    result.shape_weights = mesh.shape_weights;
    result.rest.triangles = renumbered(mesh.rest.triangles, new_of);
    for (const std::vector<int>& group : members) {
        const std::vector<Influence> mean = mean_influences(mesh, group);
        result.influences.insert(result.influences.end(), mean.begin(), mean.end());
        result.first.push_back(int(result.influences.size()));
        result.rest.positions.push_back(mesh.rest.positions[group.front()]);
        result.space_of_vertex.push_back(mesh.space_of_vertex[group.front()]);
    }
    if (!mesh.offsets.empty())
        join_offsets(mesh, members, result);
    return result;
}

} // namespace

void normalise_weights(SkinnedMesh& mesh, const std::string& source)
{
    std::vector<int> first{0};
    std::vector<Influence> kept;
    for (int v = 0; v < mesh.rest.vertex_count(); ++v) {
        double sum = 0.0;
        for (int k = mesh.first[v]; k < mesh.first[v + 1]; ++k) {
            const Influence& part = mesh.influences[k];
            if (!std::isfinite(part.weight))
                throw InvalidInput(source + ": vertex " + std::to_string(v) +
                                   " has a weight that is not finite");
            if (part.weight > 0.0) {
                kept.push_back(part);
                sum += part.weight;
            }
        }
        if (!(sum > 0.0))
            throw InvalidInput(
                source + ": vertex " + std::to_string(v) +
                " has no bone weight, so it would stay behind; weight every vertex of the skin");
        for (size_t k = first.back(); k < kept.size(); ++k)
            kept[k].weight /= sum;
        std::stable_sort(kept.begin() + first.back(), kept.end(),
                         [](const Influence& a, const Influence& b) { return a.weight > b.weight; });
        first.push_back(int(kept.size()));
    }
    mesh.first = std::move(first);
    mesh.influences = std::move(kept);
}

std::vector<int> weld_seams(SkinnedMesh& mesh, double distance)
{
    const int vertex_count = mesh.rest.vertex_count();
    std::vector<char> joinable =
        mark_edge_ends(mesh.rest.triangles, vertex_count, [](size_t triangles) { return triangles == 1; });

    // Exclude the groups on edges that joining gave too many triangles, and join again. Every pass excludes
    // at least one vertex. Edges that have too many triangles in the file itself have nothing left to
    // exclude.
    for (;;) {
        const std::vector<int> leader = leaders(mesh, joinable, distance);
        const std::vector<char> crowded =
            mark_edge_ends(renumbered(mesh.rest.triangles, leader), vertex_count,
                           [](size_t triangles) { return triangles > 2; });
        bool changed = false;
        for (int v = 0; v < vertex_count; ++v)
            if (crowded[leader[v]] && joinable[v]) {
                joinable[v] = 0;
                changed = true;
            }
        if (!changed) {
            std::vector<int> new_of;
            mesh = joined(mesh, leader, new_of);
            return new_of;
        }
    }
}

std::vector<int> heaviest_joints(const SkinnedMesh& mesh)
{
    std::vector<int> heaviest;
    heaviest.reserve(mesh.rest.triangles.size());
    for (const Triangle& corner : mesh.rest.triangles) {
        std::map<int, double> weight_of; // by joint: several bones may follow one
        for (const int v : corner)
            for (int k = mesh.first[v]; k < mesh.first[v + 1]; ++k)
                weight_of[mesh.bones[mesh.influences[k].bone].joint] += mesh.influences[k].weight;
        const auto max_weight =
            std::max_element(weight_of.begin(), weight_of.end(),
                             [](const auto& a, const auto& b) { return a.second < b.second; });
        heaviest.push_back(max_weight->first);
    }
    return heaviest;
}

} // namespace toile::avatars
