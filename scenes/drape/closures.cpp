#include "scenes/drape/closures.h"

namespace toile::scenes {

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
