#include "apps/toile/terminal/exports.h"

namespace toile::app {

std::vector<scene::Export> exports_of(const scenes::Scene& scene)
{
    if (!scene.exports.empty())
        return scene.exports;
    std::vector<scene::Export> exports;
    for (const std::string& name : surface_names(scene))
        exports.push_back({name + ".pc2", name});
    return exports;
}

std::vector<std::string> surface_names(const scenes::Scene& scene)
{
    std::vector<std::string> names;
    for (const scene::Cloth& cloth : scene.cloths)
        names.push_back(cloth.name);
    for (const scene::Solid& solid : scene.solids)
        names.push_back(solid.name);
    return names;
}

int surface_index(const scenes::Scene& scene, const std::string& name)
{
    const std::vector<std::string> names = surface_names(scene);
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == name)
            return int(i);
    return 0; // no name: the scene has only one, see checks.cpp
}

} // namespace toile::app
