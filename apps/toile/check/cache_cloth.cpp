#include "apps/toile/check/cache_cloth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>

#include "apps/toile/caches/exports.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/archive/names.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/sequence/numbered_files.h"
#include "scenes/format/document.h"

namespace toile::app {

namespace {

/// Relative difference of equal frame rates [-]: 24 and 24000/1001 differ by ten times as much.
constexpr double kSameRate = 1e-4;

/// Name of a cloth: skirt for skirt.pc2, for the unfinished skirt.partial.pc2 and for skirt_####.obj.
std::string name_of(const std::filesystem::path& cache)
{
    if (exports::NumberedFiles::has_digits_placeholder(cache))
        return exports::NumberedFiles(cache).stem();
    std::filesystem::path name = exports::archive_of(cache).filename();
    while (lower_case_extension(name) == ".partial" || exports::known_cache_format(name))
        name = name.stem();
    return name.string();
}

/// Whether a path ends with all parts of another one.
bool ends_with(const std::filesystem::path& path, const std::filesystem::path& end)
{
    const std::filesystem::path whole = std::filesystem::absolute(path).lexically_normal();
    const std::filesystem::path last = end.lexically_normal();
    const auto parts = std::distance(last.begin(), last.end());
    return std::distance(whole.begin(), whole.end()) >= parts &&
           std::equal(last.begin(), last.end(), std::prev(whole.end(), parts));
}

/// The only entry for which a rule holds; null: there is none.
/// @throws InvalidInput for several
const scene::Export* only_entry(const scenes::Scene& scene, const std::filesystem::path& cache,
                                const std::function<bool(const scene::Export&)>& fits)
{
    const scene::Export* found = nullptr;
    for (const scene::Export& entry : scene.exports) {
        if (!fits(entry))
            continue;
        if (found != nullptr)
            throw InvalidInput(cache.string() + ": may be " + found->file.string() + " or " +
                               entry.file.string() + " of " + scene.source.string() +
                               "; keep it in the folder of its name, or check the output folder");
        found = &entry;
    }
    return found;
}

/// The export of a scene that writes a file of this path, else of this name; null: there is none.
const scene::Export* listed_entry(const scenes::Scene& scene, const std::filesystem::path& cache)
{
    const std::filesystem::path file = exports::archive_of(cache);
    const auto has_same_name = [&](const scene::Export& entry) {
        return name_of(entry.file) == name_of(file) &&
               lower_case_extension(entry.file) == lower_case_extension(file);
    };
    const auto has_same_path = [&](const scene::Export& entry) { return ends_with(file, entry.file); };
    const scene::Export* const of_path = only_entry(scene, cache, has_same_path);
    return of_path != nullptr ? of_path : only_entry(scene, cache, has_same_name);
}

/// Index of a cloth by its name or by what it is called in an archive; -1: none.
int index_of(const std::vector<std::string>& names, const std::string& name)
{
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] == name || exports::clean_name(names[i]) == name)
            return int(i);
    return -1;
}

/// Index of the cloth that a mesh of an archive is, or is a panel of; -1: none, such as an avatar.
int surface_of_mesh(const std::vector<std::string>& names, const std::filesystem::path& mesh)
{
    for (std::filesystem::path at = exports::mesh_path_of(mesh); at.has_relative_path();
         at = at.parent_path())
        if (const int index = index_of(names, at.filename().string()); index >= 0)
            return index;
    return -1;
}

int named_surface(const scenes::Scene& scene, const std::vector<std::string>& names, const std::string& named)
{
    if (const int index = index_of(names, named); index >= 0)
        return index;
    const std::string near = nearest_word(named, names);
    throw InvalidInput("--cloth: " + scene.source.string() + " has no cloth \"" + named + "\"; " +
                       (near.empty() ? "it has " + scene_format::enumerate(names, "and")
                                     : "did you mean \"" + near + "\"?"));
}

} // namespace

std::vector<ClothInCache> cloths_of_cache(const scenes::Scene& scene, const std::filesystem::path& cache,
                                          const std::string& named, const scene::Export& unlisted)
{
    const std::vector<std::string> names = scenes::surface_names(scene);
    const scene::Export* const listed = listed_entry(scene, cache);
    scene::Export entry = listed != nullptr ? *listed : unlisted;
    if (listed != nullptr)
        entry.start_frame = start_frame_of(entry);
    else
        entry.file = exports::archive_of(cache);
    if (!named.empty())
        return {{cache, entry, named_surface(scene, names, named)}};
    const bool is_mesh = !exports::mesh_path_of(cache).empty();
    std::vector<ClothInCache> cloths;
    if (listed != nullptr && !is_mesh) {
        for (const int surface : surfaces_of(scene, entry))
            cloths.push_back({cache, entry, surface});
        return cloths;
    }
    if (const int index = index_of(names, name_of(cache)); index >= 0 && !is_mesh)
        return {{cache, entry, index}};
    for (const std::filesystem::path& mesh : exports::meshes_of_cache(cache)) {
        const int surface = surface_of_mesh(names, mesh);
        if (surface >= 0 && std::none_of(cloths.begin(), cloths.end(),
                                         [&](const ClothInCache& cloth) { return cloth.surface == surface; }))
            cloths.push_back({is_mesh ? cache : exports::archive_of(mesh), entry, surface});
    }
    if (!cloths.empty())
        return cloths;
    if (names.size() == 1)
        return {{cache, entry, 0}};
    throw InvalidInput(cache.string() + ": can't tell which cloth of " + scene.source.string() +
                       " this is; give --cloth with one of " + scene_format::enumerate(names, "or"));
}

void require_same_points(const exports::PointCache& cache, const std::filesystem::path& file,
                         const std::string& cloth, int vertex_count)
{
    if (cache.vertex_count() != vertex_count)
        throw InvalidInput(file.string() + ": has " + std::to_string(cache.vertex_count()) +
                           " points, but the cloth \"" + cloth + "\" has " + std::to_string(vertex_count) +
                           (cache.vertex_count() == 2 * vertex_count
                                ? "; it seems to be closed with a thickness: check the folder of its run, or "
                                  "add the export with \"thickness\" to the scene"
                                : "; give the scene that the cache was made from"));
}

void require_same_times(const exports::PointCache& cache, const std::filesystem::path& file, double fps,
                        int frame_count)
{
    char text[160];
    if (!cache.times().empty()) {
        std::snprintf(text, sizeof text, ": has samples at irregular times, but the scene has %.6g a second",
                      fps);
        throw InvalidInput(file.string() + text + "; give the scene that the cache was made from");
    }
    if (cache.fps() && std::abs(*cache.fps() - fps) > kSameRate * fps) {
        std::snprintf(text, sizeof text, ": has %.6g frames a second, but the scene has %.6g", *cache.fps(),
                      fps);
        throw InvalidInput(file.string() + text + "; give the scene that the cache was made from");
    }
    if (std::abs(cache.start_frame()) > 1e-3 && cache.frame_count() < frame_count) {
        std::snprintf(text, sizeof text, ": begins %.6g frames after the scene and is shorter",
                      cache.start_frame());
        throw InvalidInput(file.string() + text + "; give all frames from the first on");
    }
}

} // namespace toile::app
