#include "apps/toile/simulate/scene_job.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>

#include "apps/toile/caches/cache_files.h"
#include "apps/toile/caches/exports.h"
#include "apps/toile/check/certify.h"
#include "apps/toile/terminal/scene_inputs.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "export/cache_format.h"
#include "export/folder_lock.h"
#include "export/usd/usd_python.h"

namespace toile::app {

namespace {

using std::filesystem::path;

/// The surfaces of an export, for messages.
std::string contents_of(const scenes::Scene& scene, const scene::Export& entry)
{
    const std::vector<std::string> names = scenes::surface_names(scene);
    std::string list;
    for (const int surface : surfaces_of(scene, entry))
        list += (list.empty() ? "\"" : ", \"") + names[size_t(surface)] + "\"";
    return list;
}

/// Whether the start meshes of two exports are the same.
bool have_same_start(const scenes::Scene& scene, const scene::Export& a, const scene::Export& b)
{
    return surfaces_of(scene, a) == surfaces_of(scene, b) && axes_of(a) == axes_of(b) &&
           a.thickness == b.thickness;
}

void add_outputs(FilePlan& plan, const SceneJob& job)
{
    for (const ExportFile& cache : caches_of(job))
        add_cache_output(plan, cache.file, start_frame_of(cache.entry), sample_count(job.scene, cache.entry),
                         "the cache of " + contents_of(job.scene, cache.entry));
    for (const ExportFile& mesh : start_meshes_of(job))
        add_output_and_partial(plan, mesh.file, "the start mesh of " + contents_of(job.scene, mesh.entry));
    for (const path& folder : output_folders_of(job))
        plan.add_output(exports::FolderLock::file_in(folder), "the lock of the folder");
    for (const path& certificate : certificates_of(job))
        add_output_and_partial(plan, certificate, "the certificate");
    if (!job.report.empty())
        add_output_and_partial(plan, job.report, "the report");
}

void require_usd_if_needed(const path& cache, const std::string& remedy)
{
    if (exports::cache_format(cache) != exports::CacheFormat::Usd)
        return;
    try {
        exports::require_usd_python(cache);
    } catch (const InvalidInput&) {
        throw InvalidInput(cache.string() + ": is checked by Python with USD, which is not there " +
                           "(pip install usd-core)" + remedy);
    }
}

} // namespace

std::vector<ExportFile> caches_of(const SceneJob& job)
{
    std::vector<ExportFile> caches;
    for (const scene::Export& entry : exports_of(job.scene))
        caches.push_back({job.folder / entry.file.lexically_normal(), entry});
    return caches;
}

std::vector<ExportFile> start_meshes_of(const SceneJob& job)
{
    const std::vector<ExportFile> caches = caches_of(job);
    std::vector<ExportFile> meshes;
    for (const ExportFile& cache : caches) {
        const ExportFile mesh{path(cache.file).replace_extension(".obj"), cache.entry};
        const auto is_same = [&](const ExportFile& other) {
            return other.file == mesh.file && have_same_start(job.scene, other.entry, mesh.entry);
        };
        if (!exports::features_of(exports::cache_format(cache.file)).faces &&
            std::none_of(caches.begin(), caches.end(), is_same) &&
            std::none_of(meshes.begin(), meshes.end(), is_same))
            meshes.push_back(mesh);
    }
    return meshes;
}

std::vector<path> output_folders_of(const SceneJob& job)
{
    std::map<path, path> by_canonical;
    const auto add = [&](const path& folder) {
        // With a slash at the end, which a folder that exists does not keep otherwise.
        by_canonical.try_emplace(std::filesystem::weakly_canonical(folder / ""), folder);
    };
    add(job.folder);
    for (const ExportFile& cache : caches_of(job))
        add(cache.file.parent_path());
    std::vector<path> folders;
    folders.reserve(by_canonical.size());
    for (const auto& [canonical, folder] : by_canonical)
        folders.push_back(folder);
    return folders;
}

std::vector<path> certificates_of(const SceneJob& job)
{
    std::set<path> certificates;
    for (const path& folder : output_folders_of(job))
        certificates.insert(folder / kCertificateName);
    for (const ExportFile& cache : caches_of(job))
        certificates.insert(certificate_beside(cache.file));
    return {certificates.begin(), certificates.end()};
}

void require_checkable(const SceneJob& job)
{
    const std::vector<std::string> names = scenes::surface_names(job.scene);
    const std::vector<scene::Export> entries = exports_of(job.scene);
    const auto is_simulated = [&](int surface) { return surface < simulated_count(job.scene); };
    if (std::none_of(entries.begin(), entries.end(), [&](const scene::Export& entry) {
            const std::vector<int> surfaces = surfaces_of(job.scene, entry);
            return std::any_of(surfaces.begin(), surfaces.end(), is_simulated);
        }))
        throw InvalidInput(job.folder.string() + ": gets render surfaces only, which nothing collides with; "
                                                 "export their soft bodies as well, or give --no-check");
    for (int surface = 0; surface < simulated_count(job.scene); ++surface) {
        const std::string remedy =
            "; export \"" + names[size_t(surface)] + "\" to a .pc2 as well, or give --no-check";
        if (const std::optional<size_t> checked = export_to_check(job.scene, entries, surface)) {
            require_usd_if_needed(job.folder / entries[*checked].file, remedy);
            continue;
        }
        for (const scene::Export& entry : entries)
            if (const std::vector<int> surfaces = surfaces_of(job.scene, entry);
                std::find(surfaces.begin(), surfaces.end(), surface) != surfaces.end())
                throw InvalidInput((job.folder / entry.file).string() +
                                   ": is for other programs and can't be checked" + remedy);
    }
}

void require_safe_outputs(const std::vector<SceneJob>& jobs)
{
    FilePlan plan;
    for (const SceneJob& job : jobs)
        add_inputs(plan, job.scene);
    for (const SceneJob& job : jobs)
        add_outputs(plan, job);
    for (const SceneJob& job : jobs) {
        for (const path& folder : output_folders_of(job)) {
            exports::FolderLock::require_free(folder);
            require_writable_folder(folder);
        }
        for (const ExportFile& cache : caches_of(job))
            require_writable_cache(cache.file, start_frame_of(cache.entry),
                                   sample_count(job.scene, cache.entry));
        for (const ExportFile& mesh : start_meshes_of(job)) {
            require_replaceable(mesh.file);
            require_writable(partial_beside(mesh.file));
        }
        for (const path& certificate : certificates_of(job))
            require_replaceable(certificate);
        if (!job.report.empty())
            require_writable(job.report);
    }
}

} // namespace toile::app
