#include "scenes/surfaces/edge_paths.h"

#include <algorithm>

#include "core/base/error.h"

namespace toile::scenes {

namespace {

std::array<int, 2> ends_of(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

std::string file_numbers(const std::set<int>& vertices, const ClothState& cloth)
{
    std::set<int> numbers;
    for (const int v : vertices)
        numbers.insert(cloth.file_vertex(v));
    std::string text;
    for (const int v : numbers)
        text += (text.empty() ? "" : ", ") + std::to_string(v);
    return text;
}

} // namespace

EdgePaths::EdgePaths(const ClothState& cloth, const Topology& topology) : cloth_(cloth), topology_(topology)
{
    for (int e = 0; e < int(topology.edges.size()); ++e) {
        const auto [v0, v1] = topology.edges[e].vertex;
        const auto [entry, is_new] = edges_.try_emplace(ends_of(v0, v1), e);
        if (!is_new && topology.edges[entry->second].is_border())
            entry->second = e;
    }
}

std::vector<int> EdgePaths::along(const std::vector<int>& vertices, const std::string& location,
                                  const std::string& remedy) const
{
    std::vector<int> edges;
    int last = -1;
    for (size_t i = 0; i < vertices.size(); ++i) {
        const std::string place = location + "[" + std::to_string(i) + "]";
        const int vertex = cloth_.vertex_of_file(vertices[i], place, remedy);
        if (i > 0) {
            const auto edge = edges_.find(ends_of(last, vertex));
            if (edge == edges_.end())
                throw InvalidInput(place + ": no edge joins vertices " + std::to_string(vertices[i - 1]) +
                                   " and " + std::to_string(vertices[i]) + "; edges join " +
                                   std::to_string(vertices[i - 1]) + " to " +
                                   file_numbers(neighbours(last), cloth_));
            edges.push_back(edge->second);
        }
        last = vertex;
    }
    return edges;
}

std::set<int> EdgePaths::neighbours(int vertex) const
{
    std::set<int> result;
    for (const Edge& edge : topology_.edges)
        for (int k = 0; k < 2; ++k)
            if (edge.vertex[k] == vertex)
                result.insert(edge.vertex[1 - k]);
    return result;
}

} // namespace toile::scenes
