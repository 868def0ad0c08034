#include "apps/toile/exports.h"

namespace toile {

std::vector<scene::Export> exports_of(const Scene& scene)
{
    if (!scene.exports.empty())
        return scene.exports;
    std::vector<scene::Export> exports;
    for (const scene::Cloth& cloth : scene.cloths)
        exports.push_back({cloth.name + ".pc2", cloth.name});
    return exports;
}

int cloth_index(const Scene& scene, const std::string& name)
{
    for (size_t i = 0; i < scene.cloths.size(); ++i)
        if (scene.cloths[i].name == name)
            return int(i);
    return 0; // no name: the scene has one cloth, see checks of the scene file
}

} // namespace toile
