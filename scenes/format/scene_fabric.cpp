#include "scenes/format/scene_fabric.h"

#include <algorithm>

namespace toile::scenes {

namespace {

void replace(double& value, const std::optional<double>& by)
{
    if (by)
        value = *by;
}

/// The base preset with the numbers replaced by the scene.
garment::Fabric custom_fabric(const std::string& name, const scene::Fabric& settings,
                              const std::string& source)
{
    garment::Fabric fabric = garment::fabric_preset(settings.base, source);
    fabric.name = name;
    replace(fabric.areal_density, settings.areal_density);
    replace(fabric.stretch_warp, settings.stretch.warp);
    replace(fabric.stretch_weft, settings.stretch.weft);
    replace(fabric.shear, settings.shear);
    replace(fabric.bend_warp, settings.bend.warp);
    replace(fabric.bend_weft, settings.bend.weft);
    if (settings.strain_limit)
        fabric.strain_limit = *settings.strain_limit - 1.0;
    replace(fabric.thickness, settings.thickness);
    replace(fabric.damping, settings.damping);
    replace(fabric.stretch_damping, settings.stretch_damping);
    replace(fabric.shear_damping, settings.shear_damping);
    replace(fabric.bend_damping, settings.bend_damping);
    replace(fabric.bend_friction, settings.bend_friction);
    return fabric;
}

/// @param name  a key of the scene's fabrics, or that of a preset
garment::Fabric fabric_named(const Scene& scene, const std::string& name)
{
    const std::string source = scene.source.string();
    const auto custom = scene.fabrics.find(name);
    return custom != scene.fabrics.end() ? custom_fabric(custom->first, custom->second, source)
                                         : garment::fabric_preset(name, source);
}

} // namespace

garment::Fabric fabric_of(const Scene& scene, const scene::Cloth& cloth)
{
    garment::Fabric fabric = fabric_named(scene, cloth.fabric);
    replace(fabric.thickness, cloth.thickness);
    if (cloth.painted && cloth.painted->thickness)
        fabric.thickness = std::max(cloth.painted->thickness->from, cloth.painted->thickness->to);
    fabric.validate(scene.source.string());
    return fabric;
}

garment::Fabric fabric_of(const Scene& scene, const scene::ClothGroup& group)
{
    const garment::Fabric fabric = fabric_named(scene, group.fabric);
    fabric.validate(scene.source.string());
    return fabric;
}

} // namespace toile::scenes
