#include "apps/toile/check/cache_cloth.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "apps/toile/terminal/exports.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/cache_path.h"
#include "export/sequence/numbered_files.h"

namespace toile::app {

namespace {

/// Name of a cloth: skirt for skirt.pc2, for the unfinished skirt.partial.pc2, for skirt_####.obj, and for
/// the mesh run.abc#/skirt/skirtShape.
std::string name_of(const std::filesystem::path& cache)
{
    if (exports::NumberedFiles::has_digits_placeholder(cache))
        return exports::NumberedFiles(cache).stem();
    static const std::set<std::string> kEndings{".pc2", ".mdd", ".obj", ".ply",
                                                ".abc", ".glb", ".pvd", ".partial"};
    if (exports::archive_of(cache) != cache)
        return cache.parent_path().filename().string();
    std::filesystem::path name = cache.filename();
    while (kEndings.contains(lower_case_extension(name)))
        name = name.stem();
    return name.string();
}

} // namespace

int cloth_of_cache(const scenes::Scene& scene, const std::filesystem::path& cache, const std::string& named)
{
    const std::vector<std::string> names = surface_names(scene);
    std::string list;
    for (const std::string& name : names)
        list += (list.empty() ? "" : ", ") + name;
    const auto index_of = [&](const std::string& name) {
        for (size_t i = 0; i < names.size(); ++i)
            if (names[i] == name)
                return int(i);
        return -1;
    };

    if (!named.empty()) {
        if (const int index = index_of(named); index >= 0)
            return index;
        const std::string near = nearest_word(named, names);
        throw InvalidInput("--cloth: " + scene.source.string() + " has no cloth \"" + named + "\"; " +
                           (near.empty() ? "it has " + list : "did you mean \"" + near + "\"?"));
    }
    for (const scene::Export& entry : scene.exports)
        if (entry.file.filename() == cache.filename())
            return std::max(0, index_of(entry.cloth));
    for (const scene::Export& entry : scene.exports)
        if (name_of(entry.file) == name_of(cache))
            return std::max(0, index_of(entry.cloth));
    if (const int index = index_of(name_of(cache)); index >= 0)
        return index;
    if (names.size() == 1)
        return 0;
    throw InvalidInput(cache.string() + ": can't tell which cloth of " + scene.source.string() +
                       " this is; give --cloth with one of " + list);
}

void require_same_points(const exports::PointCache& cache, const std::filesystem::path& file,
                         const std::string& cloth, int vertex_count)
{
    if (cache.vertex_count() != vertex_count)
        throw InvalidInput(file.string() + ": has " + std::to_string(cache.vertex_count()) +
                           " points, but the cloth \"" + cloth + "\" has " + std::to_string(vertex_count) +
                           "; give the scene that the cache was made from");
}

void require_same_times(const exports::PointCache& cache, const std::filesystem::path& file, double fps)
{
    char text[160];
    if (cache.fps() && std::abs(*cache.fps() - fps) > 1e-3 * fps) {
        std::snprintf(text, sizeof text, ": has %.6g frames a second, but the scene has %.6g", *cache.fps(),
                      fps);
        throw InvalidInput(file.string() + text + "; give the scene that the cache was made from");
    }
    if (std::abs(cache.start_frame()) > 1e-3) {
        std::snprintf(text, sizeof text, ": begins at frame %.6g, but the scene at frame 0",
                      cache.start_frame());
        throw InvalidInput(file.string() + text + "; give all frames from the first on");
    }
}

} // namespace toile::app
