#include "scenes/surfaces/cloth_elastics.h"

#include <algorithm>

#include "scenes/surfaces/edge_paths.h"

namespace toile::scenes {

namespace {

/// Length of an edge at rest, mean over its triangles [m].
double rest_length(const garment::RestShape& rest, int index)
{
    const Edge& edge = rest.topology.edges[index];
    const int count = edge.is_border() ? 1 : 2;
    double sum = 0.0;
    for (int side = 0; side < count; ++side) {
        const int t = edge.triangle[side];
        const auto place = [&](int v) {
            const Triangle& corner = rest.triangles[t];
            return v == corner[0] ? Vec2(Vec2::Zero()) : Vec2(rest.edges[t].col(v == corner[1] ? 0 : 1));
        };
        sum += (place(edge.vertex[1]) - place(edge.vertex[0])).norm();
    }
    return sum / count;
}

} // namespace

std::vector<garment::Elastics::Spring> elastic_springs(const std::vector<scene::Elastic>& elastics,
                                                       const ClothState& cloth,
                                                       const garment::RestShape& rest,
                                                       const std::string& key_path)
{
    if (elastics.empty())
        return {};
    const EdgePaths paths(cloth, rest.topology);
    std::vector<garment::Elastics::Spring> springs;
    for (size_t i = 0; i < elastics.size(); ++i) {
        const scene::Elastic& elastic = elastics[i];
        const std::string location = key_path + "[" + std::to_string(i) + "].vertices";
        for (const int e : paths.along(elastic.vertices, location, "name vertices of the surface")) {
            const auto [a, b] = rest.topology.edges[e].vertex;
            springs.push_back({a, b, elastic.ratio * rest_length(rest, e), elastic.stiffness});
        }
    }
    return springs;
}

} // namespace toile::scenes
