#include "apps/toile/caches/exports.h"

#include <algorithm>
#include <numeric>

#include "export/cache_format.h"

namespace toile::app {

std::vector<scene::Export> exports_of(const scenes::Scene& scene)
{
    if (!scene.exports.empty())
        return scene.exports;
    std::vector<scene::Export> exports;
    for (const std::string& name : scenes::surface_names(scene)) {
        scene::Export& entry = exports.emplace_back();
        entry.file = name + ".pc2";
        entry.cloths = {name};
    }
    return exports;
}

std::vector<int> surfaces_of(const scenes::Scene& scene, const scene::Export& entry)
{
    const std::vector<std::string> names = scenes::surface_names(scene);
    std::vector<int> surfaces;
    for (const std::string& name : entry.cloths)
        if (const auto at = std::find(names.begin(), names.end(), name); at != names.end())
            surfaces.push_back(int(at - names.begin()));
    if (surfaces.empty()) { // none is named, or all: see export_checks.cpp
        surfaces.resize(names.size());
        std::iota(surfaces.begin(), surfaces.end(), 0);
    }
    return surfaces;
}

int start_frame_of(const scene::Export& entry)
{
    return entry.start_frame.value_or(exports::features_of(exports::cache_format(entry.file)).time_line ? 1
                                                                                                        : 0);
}

exports::Axes axes_of(const scene::Export& entry)
{
    return {entry.unit == scene::ExportUnit::Centimetre ? "cm" : "m",
            entry.up == scene::UpAxis::Z ? "z" : "y"};
}

int sample_count(const scenes::Scene& scene, const scene::Export& entry)
{
    return (scene.frames - 1) * entry.subframes + 1;
}

std::optional<size_t> export_to_check(const scenes::Scene& scene, const std::vector<scene::Export>& entries,
                                      int surface)
{
    std::optional<size_t> usd;
    for (size_t k = 0; k < entries.size(); ++k) {
        const exports::CacheFormat format = exports::cache_format(entries[k].file);
        const std::vector<int> surfaces = surfaces_of(scene, entries[k]);
        if (!exports::features_of(format).read_back ||
            std::find(surfaces.begin(), surfaces.end(), surface) == surfaces.end())
            continue;
        if (format != exports::CacheFormat::Usd)
            return k;
        usd = usd.value_or(k);
    }
    return usd;
}

int subframes_of(const scenes::Scene& scene)
{
    int subframes = 1;
    for (const scene::Export& entry : scene.exports)
        subframes = std::max(subframes, entry.subframes);
    return subframes;
}

scenes::Scene with_subframes(scenes::Scene scene, int subframes)
{
    scene.frames = (scene.frames - 1) * subframes + 1;
    scene.fps *= subframes;
    if (scene.solver.substeps)
        *scene.solver.substeps /= subframes; // a multiple: see export_checks.cpp
    return scene;
}

} // namespace toile::app
