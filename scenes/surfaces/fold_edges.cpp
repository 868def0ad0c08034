#include "scenes/surfaces/fold_edges.h"

#include <map>
#include <numbers>

#include "core/base/error.h"
#include "scenes/surfaces/edge_paths.h"

namespace toile::scenes {

std::vector<garment::FoldEdge> fold_edges(const std::vector<scene::Fold>& folds, const ClothState& cloth,
                                          const Topology& topology, const std::string& key_path)
{
    if (folds.empty())
        return {};
    const EdgePaths paths(cloth, topology);
    std::vector<garment::FoldEdge> result;
    std::map<int, size_t> fold_of_edge;
    for (size_t f = 0; f < folds.size(); ++f) {
        const scene::Fold& fold = folds[f];
        const std::string location = key_path + "[" + std::to_string(f) + "]";
        const std::vector<int> edges =
            paths.along(fold.vertices, location + ".vertices", "fold along vertices of the surface");
        for (size_t i = 0; i < edges.size(); ++i) {
            const Edge& edge = topology.edges[edges[i]];
            if (edge.is_border())
                throw InvalidInput(location + ".vertices[" + std::to_string(i + 1) +
                                   "]: an edge at the border joins vertices " +
                                   std::to_string(fold.vertices[i]) + " and " +
                                   std::to_string(fold.vertices[i + 1]) +
                                   "; cloth folds between two faces, name edges inside");
            const auto [entry, is_new] = fold_of_edge.try_emplace(edges[i], f);
            if (!is_new)
                throw InvalidInput(
                    location + ": the edge from vertex " + std::to_string(cloth.file_vertex(edge.vertex[0])) +
                    " to " + std::to_string(cloth.file_vertex(edge.vertex[1])) + " is in " +
                    (entry->second == f ? "it twice" : "folds[" + std::to_string(entry->second) + "] too") +
                    "; an edge is folded once");
            result.push_back({edges[i], fold.angle_deg * std::numbers::pi / 180.0, fold.stiffness});
        }
    }
    return result;
}

} // namespace toile::scenes
