#include "apps/toile/maps/fitted_garment.h"

#include <map>
#include <utility>

namespace toile::app {

FittedGarment fitted_garment(const std::string& name, const scenes::GarmentSurface& surface,
                             const garment::Pattern& pattern, const std::string& fabric)
{
    FittedGarment garment;
    garment.name = name;
    garment.mesh = surface.mesh.triangulated();
    garment.rest = surface.rest.empty() ? texture_triangles(surface.mesh) : surface.rest;

    std::map<std::string, std::string> fabric_of_panel;
    for (const garment::Panel& panel : pattern.panels)
        fabric_of_panel[panel.name] = panel.fabric;
    std::map<std::string, int> index;
    auto group = surface.mesh.groups.begin();
    std::string panel;
    for (int t = 0; t < garment.mesh.triangle_count(); ++t) {
        for (; group != surface.mesh.groups.end() && group->first_polygon <= t; ++group)
            panel = group->name;
        const std::string& own = fabric_of_panel[panel];
        const std::string& chosen = own.empty() ? fabric : own;
        const auto [at, is_new] = index.try_emplace(chosen, int(garment.fabrics.size()));
        if (is_new)
            garment.fabrics.push_back(garment::fabric_preset(chosen, pattern.source));
        garment.fabric_of_triangle.push_back(at->second);
    }
    return garment;
}

FittedGarment fitted_garment(const scenes::LoadedCloth& cloth, std::vector<Vec3> x)
{
    FittedGarment garment;
    garment.name = cloth.state.name;
    garment.mesh = {std::move(x), cloth.state.triangles};
    // Panels have the warp along y, and x against the weft, as rest_shape_of_panels() takes them.
    const auto in_panel = [](const Vec2& uv) { return Vec2(-uv.y(), uv.x()); };
    for (const Mat2& edges : cloth.rest->edges)
        garment.rest.push_back({Vec2(0.0, 0.0), in_panel(edges.col(0)), in_panel(edges.col(1))});
    garment.fabrics = cloth.state.fabrics();
    garment.fabric_of_triangle = cloth.state.fabric_of_triangle;
    garment.fabric_of_triangle.resize(garment.mesh.triangles.size(), 0);
    garment.stiffness = cloth.state.stiffness;
    return garment;
}

scenes::LoadedCloth unattached_cloth(const scenes::Scene& scene, size_t cloth)
{
    scenes::Scene free = scene;
    free.attachments.clear();
    return scenes::load_cloth(free, free.cloths[cloth], {}, {});
}

} // namespace toile::app
