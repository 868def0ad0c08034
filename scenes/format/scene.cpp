#include "scenes/format/scene.h"

#include "scenes/format/names.h"

namespace toile::scene {

double metres_per(LengthUnit unit)
{
    switch (unit) {
    case LengthUnit::Centimetre:
        return 0.01;
    case LengthUnit::Millimetre:
        return 0.001;
    case LengthUnit::Inch:
        return 0.0254;
    case LengthUnit::Metre:
        break;
    }
    return 1.0;
}

} // namespace toile::scene

namespace toile::scenes {

const scene::SoftBody* replacement_of(const Scene& scene, const std::string& avatar)
{
    const auto found =
        std::find_if(scene.soft_bodies.begin(), scene.soft_bodies.end(),
                     [&](const scene::SoftBody& body) { return body.core && body.core->avatar == avatar; });
    return found == scene.soft_bodies.end() ? nullptr : &*found;
}

std::vector<std::string> surface_names(const Scene& scene)
{
    std::vector<std::string> all;
    for (const auto& names : {scene_format::names_of(scene.cloths), scene_format::names_of(scene.solids),
                              scene_format::names_of(scene.soft_bodies)})
        all.insert(all.end(), names.begin(), names.end());
    for (const scene::SoftBody& body : scene.soft_bodies)
        if (body.render)
            all.push_back(body.render_name());
    return all;
}

int simulated_count(const Scene& scene)
{
    return int(scene.cloths.size() + scene.solids.size() + scene.soft_bodies.size());
}

} // namespace toile::scenes
