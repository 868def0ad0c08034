#include "scenes/format/read_scene.h"

#include <string>

#include "scenes/format/cache_files.h"
#include "scenes/format/checks/checks.h"
#include "scenes/format/reader.h"

namespace toile::scenes {

namespace {

/// Replaces the path of every file alternative by the path of the existing file.
template <typename Object>
void resolve_files(const scene_format::Document& document, const std::string& list,
                   std::vector<Object>& objects)
{
    for (size_t i = 0; i < objects.size(); ++i)
        if (auto* file = std::get_if<std::filesystem::path>(&objects[i].shape))
            *file = scene_format::existing_cache(document, *file,
                                                 scene_format::below(scene_format::below(list, i), "file"));
}

/// Replaces the paths of meshes, and gives caches without times the rate of the scene.
void resolve_caches(const scene_format::Document& document, Scene& scene)
{
    using scene_format::below;
    for (size_t i = 0; i < scene.avatars.size(); ++i) {
        scene::Avatar& avatar = scene.avatars[i];
        if (auto& mesh = avatar.mesh)
            *mesh = scene_format::existing_cache(document, *mesh, below(below("avatars", i), "mesh"));
        const auto* file = std::get_if<std::filesystem::path>(&avatar.shape);
        if (file != nullptr && scene_format::is_cache(*file) && !scene_format::has_times(*file) &&
            !avatar.fps)
            avatar.fps = scene.fps;
    }
}

/// Replaces the paths of motions and of their maps.
void resolve_motions(const scene_format::Document& document, std::vector<scene::Avatar>& avatars)
{
    using scene_format::below;
    for (size_t i = 0; i < avatars.size(); ++i)
        if (auto& motion = avatars[i].motion) {
            const std::string key_path = below(below("avatars", i), "motion");
            motion->file = document.existing_file(motion->file.string(), below(key_path, "file"));
            if (motion->is_mapped_by_file())
                motion->map = document.existing_file(motion->map, below(key_path, "map")).string();
        }
}

void resolve_rest_files(const scene_format::Document& document, std::vector<scene::Cloth>& cloths)
{
    for (size_t i = 0; i < cloths.size(); ++i)
        if (auto& file = cloths[i].rest_file)
            *file = scene_format::existing_cache(
                document, *file, scene_format::below(scene_format::below("cloths", i), "rest_file"));
}

} // namespace

Scene read_scene(const std::filesystem::path& file)
{
    return parse_scene(scene_format::read_document(file, "scene file"), file);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& source)
{
    const scene_format::Document document(source);
    scene_format::Json json = document.parse(text);
    if (json.is_object() && (json.contains("toile_garment") || json.contains("pattern")))
        document.refuse("", "is a sewing pattern, not a scene; look at it with toile pattern show");
    auto scene = scene_format::read_described<Scene>(document, std::move(json));
    scene.source = source;
    if (scene.name.empty())
        scene.name = source.stem().string();
    scene_format::require_consistent(document, scene);
    for (scene::Cloth& cloth : scene.cloths)
        cloth.print = cloth.pattern.value_or(cloth.print);
    resolve_files(document, "avatars", scene.avatars);
    resolve_caches(document, scene);
    resolve_motions(document, scene.avatars);
    resolve_files(document, "cloths", scene.cloths);
    resolve_files(document, "solids", scene.solids);
    for (size_t i = 0; i < scene.soft_bodies.size(); ++i) {
        scene::SoftBody& body = scene.soft_bodies[i];
        for (const auto& [key, file] : {std::pair("file", &body.file), std::pair("render", &body.render)})
            if (*file)
                *file = document.existing_file(
                    (*file)->string(), scene_format::below(scene_format::below("soft_bodies", i), key));
    }
    resolve_rest_files(document, scene.cloths);
    return scene;
}

} // namespace toile::scenes
