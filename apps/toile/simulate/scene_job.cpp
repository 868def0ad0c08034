#include "apps/toile/simulate/scene_job.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>

#include "apps/toile/check/certify.h"
#include "apps/toile/terminal/cache_files.h"
#include "apps/toile/terminal/exports.h"
#include "apps/toile/terminal/scene_inputs.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "export/cache_format.h"
#include "export/folder_lock.h"

namespace toile::app {

namespace {

using std::filesystem::path;

void add_outputs(FilePlan& plan, const SceneJob& job)
{
    const std::vector<std::string> names = surface_names(job.scene);
    for (const SurfaceFile& cache : caches_of(job))
        add_cache_output(plan, cache.file, 0, job.scene.frames,
                         "the cache of \"" + names[size_t(cache.surface)] + "\"");
    for (const SurfaceFile& mesh : start_meshes_of(job))
        add_output_and_partial(plan, mesh.file, "the start mesh of \"" + names[size_t(mesh.surface)] + "\"");
    for (const path& folder : output_folders_of(job))
        plan.add_output(exports::FolderLock::file_in(folder), "the lock of the folder");
    for (const path& certificate : certificates_of(job))
        add_output_and_partial(plan, certificate, "the certificate");
    if (!job.report.empty())
        add_output_and_partial(plan, job.report, "the report");
}

} // namespace

std::vector<SurfaceFile> caches_of(const SceneJob& job)
{
    std::vector<SurfaceFile> caches;
    for (const scene::Export& entry : exports_of(job.scene))
        caches.push_back({job.folder / entry.file.lexically_normal(), surface_index(job.scene, entry.cloth)});
    return caches;
}

std::vector<SurfaceFile> start_meshes_of(const SceneJob& job)
{
    const std::vector<SurfaceFile> caches = caches_of(job);
    std::vector<SurfaceFile> meshes;
    for (const SurfaceFile& cache : caches) {
        const SurfaceFile mesh{path(cache.file).replace_extension(".obj"), cache.surface};
        const auto is_same = [&](const SurfaceFile& other) {
            return other.file == mesh.file && other.surface == mesh.surface;
        };
        if (!exports::stores_faces(exports::cache_format(cache.file)) &&
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
    for (const SurfaceFile& cache : caches_of(job))
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
    for (const SurfaceFile& cache : caches_of(job))
        certificates.insert(certificate_beside(cache.file));
    return {certificates.begin(), certificates.end()};
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
        for (const SurfaceFile& cache : caches_of(job))
            require_writable_cache(cache.file, 0, job.scene.frames);
        for (const SurfaceFile& mesh : start_meshes_of(job)) {
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
