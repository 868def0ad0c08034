#include "apps/toile/fit/fitted_garment.h"

#include <map>

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

} // namespace toile::app
