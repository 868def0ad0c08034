#include "apps/toile/terminal/scene_inputs.h"

#include <string>
#include <variant>

#include "avatars/import/gltf_import.h"
#include "scenes/format/cache_files.h"

namespace toile::app {

namespace {

using std::filesystem::path;

template <typename Object>
void add_file_of(FilePlan& plan, const Object& object, const std::string& kind)
{
    const path* file = std::get_if<path>(&object.shape);
    if (file == nullptr)
        return;
    for (const path& part : scene_format::files_of(*file))
        plan.add_input(part, "the file of " + kind + " \"" + object.name + "\"");
}

} // namespace

void add_inputs(FilePlan& plan, const scenes::Scene& scene)
{
    plan.add_input(scene.source, "the scene");
    for (const scene::Cloth& cloth : scene.cloths) {
        add_file_of(plan, cloth, "cloth");
        if (cloth.rest_file)
            for (const path& part : scene_format::files_of(*cloth.rest_file))
                plan.add_input(part, "the rest file of cloth \"" + cloth.name + "\"");
    }
    for (const scene::Solid& solid : scene.solids)
        add_file_of(plan, solid, "solid");
    for (const scene::SoftBody& body : scene.soft_bodies) {
        if (body.file)
            plan.add_input(*body.file, "the file of soft body \"" + body.name + "\"");
        if (body.render)
            plan.add_input(*body.render, "the render surface of soft body \"" + body.name + "\"");
    }
    for (const scene::Avatar& avatar : scene.avatars) {
        add_file_of(plan, avatar, "avatar");
        if (avatar.mesh)
            for (const path& part : scene_format::files_of(*avatar.mesh))
                plan.add_input(part, "the mesh of avatar \"" + avatar.name + "\"");
        if (const auto* file = std::get_if<path>(&avatar.shape);
            file != nullptr && !scene_format::is_cache(*file) && avatars::is_gltf(*file))
            for (const path& part : avatars::files_of_gltf(*file))
                plan.add_input(part, "a part of " + file->string());
        if (avatar.motion) {
            plan.add_input(avatar.motion->file, "the motion of avatar \"" + avatar.name + "\"");
            if (avatar.motion->is_mapped_by_file())
                plan.add_input(avatar.motion->map, "the map of joints of avatar \"" + avatar.name + "\"");
        }
    }
}

} // namespace toile::app
