#include "scenes/surfaces/fold_edges.h"

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "core/base/error.h"

namespace toile::scenes {

namespace {

/// Location of a fold in errors: pleats.json: cloths[0].folds[1].
std::string location_of(const Scene& scene, const std::string& cloth, size_t fold)
{
    size_t index = 0;
    while (index < scene.cloths.size() && scene.cloths[index].name != cloth)
        ++index;
    return scene.source.string() + ": cloths[" + std::to_string(index) + "].folds[" + std::to_string(fold) +
           "]";
}

/// Edges by their vertices, in ascending order. Where more than two faces share one, those at the border come
/// last.
class EdgeTable {
public:
    explicit EdgeTable(const Topology& topology) : topology_(topology)
    {
        for (int e = 0; e < int(topology.edges.size()); ++e) {
            const auto [entry, is_new] = edges_.try_emplace(ends_of(topology.edges[e].vertex), e);
            if (!is_new && topology.edges[entry->second].is_border())
                entry->second = e;
        }
    }

    /// -1: no edge joins the vertices.
    int find(int a, int b) const
    {
        const auto entry = edges_.find(ends_of({a, b}));
        return entry == edges_.end() ? -1 : entry->second;
    }

    std::set<int> neighbours(int vertex) const
    {
        std::set<int> result;
        for (const Edge& edge : topology_.edges)
            for (int k = 0; k < 2; ++k)
                if (edge.vertex[k] == vertex)
                    result.insert(edge.vertex[1 - k]);
        return result;
    }

private:
    static std::array<int, 2> ends_of(const std::array<int, 2>& v)
    {
        return {std::min(v[0], v[1]), std::max(v[0], v[1])};
    }

    const Topology& topology_;
    std::map<std::array<int, 2>, int> edges_;
};

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

/// Edges along one fold.
std::vector<int> edges_along(const std::vector<int>& vertices, const ClothState& cloth,
                             const EdgeTable& table, const Topology& topology, const std::string& location)
{
    std::vector<int> edges, path;
    for (size_t i = 0; i < vertices.size(); ++i) {
        const std::string place = location + ".vertices[" + std::to_string(i) + "]";
        path.push_back(cloth.vertex_of_file(vertices[i], place, "fold along vertices of the surface"));
        if (i == 0)
            continue;
        const std::string between =
            " joins vertices " + std::to_string(vertices[i - 1]) + " and " + std::to_string(vertices[i]);
        const int edge = table.find(path[i - 1], path[i]);
        if (edge < 0)
            throw InvalidInput(place + ": no edge" + between + "; edges join " +
                               std::to_string(vertices[i - 1]) + " to " +
                               file_numbers(table.neighbours(path[i - 1]), cloth));
        if (topology.edges[edge].is_border())
            throw InvalidInput(place + ": an edge at the border" + between +
                               "; cloth folds between two faces, name edges inside");
        edges.push_back(edge);
    }
    return edges;
}

} // namespace

std::vector<garment::FoldEdge> fold_edges(const Scene& scene, const scene::Cloth& settings,
                                          const ClothState& cloth, const Topology& topology)
{
    if (settings.folds.empty())
        return {};
    const EdgeTable table(topology);
    std::vector<garment::FoldEdge> result;
    std::map<int, size_t> fold_of_edge;
    for (size_t f = 0; f < settings.folds.size(); ++f) {
        const scene::Fold& fold = settings.folds[f];
        const std::string location = location_of(scene, settings.name, f);
        for (const int edge : edges_along(fold.vertices, cloth, table, topology, location)) {
            const auto [entry, is_new] = fold_of_edge.try_emplace(edge, f);
            const auto [a, b] = topology.edges[edge].vertex;
            if (!is_new)
                throw InvalidInput(
                    location + ": the edge from vertex " + std::to_string(cloth.file_vertex(a)) + " to " +
                    std::to_string(cloth.file_vertex(b)) + " is in " +
                    (entry->second == f ? "it twice" : "folds[" + std::to_string(entry->second) + "] too") +
                    "; an edge is folded once");
            result.push_back({edge, fold.angle_deg * std::numbers::pi / 180.0, fold.stiffness});
        }
    }
    return result;
}

} // namespace toile::scenes
