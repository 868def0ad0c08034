#include "scenes/drape/notions.h"

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

int nearest_vertex(const garment::PatternMesh& mesh, const garment::PanelPoint& point)
{
    const auto panel = size_t(point.panel);
    int nearest = mesh.first_vertex[panel];
    for (int v = nearest; v < mesh.first_vertex[panel + 1]; ++v)
        if ((mesh.uv[size_t(v)] - point.point).squaredNorm() <
            (mesh.uv[size_t(nearest)] - point.point).squaredNorm())
            nearest = v;
    return nearest;
}

std::vector<scene::Tack> tacks_of(const garment::Pattern& pattern, const garment::PatternMesh& mesh,
                                  const garment::SewnMesh& partly)
{
    const auto welded = [&](const garment::PanelPoint& point) {
        return partly.welded_of[size_t(nearest_vertex(mesh, point))];
    };
    std::vector<scene::Tack> tacks;
    for (const garment::Closure& closure : pattern.closures) {
        const scene::Tack tack{welded(closure.a), welded(closure.b), closure.close_at};
        if (tack.a != tack.b)
            tacks.push_back(tack);
    }
    return tacks;
}

std::vector<double> closure_gaps(const garment::Pattern& pattern, const GarmentMesh& mesh, View<const Vec3> x)
{
    const auto at = [&](const garment::PanelPoint& point) {
        return x[mesh.sewn.welded_of[size_t(nearest_vertex(mesh.panels, point))]];
    };
    std::vector<double> gaps;
    for (const garment::Closure& closure : pattern.closures)
        gaps.push_back((at(closure.a) - at(closure.b)).norm());
    return gaps;
}

} // namespace toile::scenes
