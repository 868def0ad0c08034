#include "scenes/drape/elastics.h"

#include <algorithm>
#include <cmath>

namespace toile::scenes {

namespace {

size_t nearest(const std::vector<garment::EdgeVertex>& edge, double fraction)
{
    const auto distance = [&](const garment::EdgeVertex& at) { return std::abs(at.fraction - fraction); };
    return size_t(std::min_element(edge.begin(), edge.end(),
                                   [&](const auto& a, const auto& b) { return distance(a) < distance(b); }) -
                  edge.begin());
}

} // namespace

std::vector<int> path_along(const garment::EdgePart& part, const GarmentMesh& mesh)
{
    const auto& edge = mesh.panels.vertices_along(part.panel, part.edge);
    size_t first = nearest(edge, std::min(part.from, part.to)),
           last = nearest(edge, std::max(part.from, part.to));
    if (first == last && last + 1 < edge.size())
        ++last;
    else if (first == last)
        --first;
    std::vector<int> path;
    for (size_t i = first; i <= last; ++i)
        path.push_back(mesh.sewn.welded_of[size_t(edge[i].vertex)]);
    return path;
}

std::vector<scene::Elastic> elastics_of(const garment::Pattern& pattern, const GarmentMesh& mesh)
{
    std::vector<scene::Elastic> elastics;
    for (const garment::Elastic& elastic : pattern.elastics)
        for (const garment::EdgePart& part : elastic.edges)
            elastics.push_back({path_along(part, mesh), elastic.ratio, elastic.stiffness});
    return elastics;
}

} // namespace toile::scenes
