#include "apps/toile/simulate/run_files.h"

#include <algorithm>
#include <functional>
#include <system_error>
#include <utility>

#include "apps/toile/caches/exports.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/binary_file.h"
#include "export/cache_format.h"

namespace toile::app {

RunFiles::RunFiles(const SceneJob& job, const scenes::World& world, const RunLog& log)
    : job_(job), subframes_(subframes_of(job.scene))
{
    for (const std::filesystem::path& folder : output_folders_of(job))
        locks_.all.emplace_back(folder, [&](const std::string& text) { log.note("warning: " + text); });
    const std::vector<ExportFile> caches = caches_of(job);
    if (std::any_of(caches.begin(), caches.end(),
                    [](const ExportFile& file) { return needs_avatars(file.entry); }))
        avatars_ = scenes::make_bodies(job.scene);
    std::vector<std::pair<std::string, const TriangleMesh*>> avatars;
    for (const scenes::SceneBody& avatar : avatars_)
        avatars.emplace_back(avatar.settings().name, &avatar.surface());
    const View<const scenes::ClothState> surfaces = world.surfaces();
    for (const ExportFile& cache : caches) {
        auto contents = std::make_shared<CacheContents>(cache.entry, job.scene, surfaces, avatars);
        auto writer =
            std::make_unique<exports::AsyncCacheWriter>(make_cache_writer(cache.file, contents->layout()));
        caches_.push_back({cache, std::move(contents), std::move(writer), {}});
    }
    for (const ExportFile& mesh : start_meshes_of(job)) {
        CacheContents contents(mesh.entry, job.scene, surfaces, {});
        meshes_.push_back({mesh.file, contents.layout().meshes.front().faces});
        const auto start = [&](int surface) { return View<const Vec3>(surfaces[surface].positions); };
        meshes_.back().mesh.positions = contents.sample(start, {}).positions;
    }
}

void RunFiles::write_start_meshes()
{
    for (StartMesh& mesh : meshes_) {
        write_obj(partial_beside(mesh.file), mesh.mesh);
        mesh.mesh = {};
    }
}

/// Positions of the avatars' surfaces [avatars][vertices] [m].
std::vector<std::vector<Vec3>> RunFiles::avatar_positions(int sample)
{
    std::vector<std::vector<Vec3>> positions;
    for (scenes::SceneBody& avatar : avatars_) {
        avatar.advance_to(sample * job_.scene.frame_duration() / subframes_);
        positions.push_back(avatar.surface().positions);
    }
    return positions;
}

void RunFiles::write_sample(const scenes::World& world)
{
    if (!std::exchange(has_frames_, true))
        write_start_meshes();
    const std::shared_ptr<const scenes::Snapshot> snapshot = world.snapshot();
    const auto avatars =
        std::make_shared<const std::vector<std::vector<Vec3>>>(avatar_positions(world.frame()));
    for (Cache& cache : caches_) {
        const int apart =
            subframes_ / cache.target.entry.subframes; // samples of the run per one of the cache
        if (world.frame() % apart != 0)
            continue;
        cache.writer->write_later(world.frame() / apart, [snapshot, avatars, contents = cache.contents] {
            return contents->sample([&](int surface) { return snapshot->positions(surface); }, *avatars);
        });
    }
}

RunFiles::Partials RunFiles::close()
{
    Partials partials;
    for (Cache& cache : caches_) {
        const int samples = cache.writer->close();
        std::error_code missing;
        if (samples == 0 || !std::filesystem::exists(cache.writer->partial(), missing))
            continue;
        const int frames = (samples - 1) / cache.target.entry.subframes + 1;
        partials.frame_count = std::max(partials.frame_count, frames);
        partials.files.push_back(cache.writer->partial());
    }
    if (has_frames_ && partials.frame_count == 0)
        for (const StartMesh& mesh : meshes_) {
            std::error_code missing;
            std::filesystem::remove(partial_beside(mesh.file), missing);
        }
    return partials;
}

void RunFiles::complete()
{
    for (Cache& cache : caches_) {
        try {
            cache.complete = cache.writer->complete();
        } catch (const InvalidInput& error) {
            if (exports::features_of(exports::cache_format(cache.target.file)).read_back)
                throw;
            undelivered_.push_back(error.what());
        }
    }
}

std::vector<std::filesystem::path> RunFiles::completed() const
{
    std::vector<std::filesystem::path> files;
    for (const Cache& cache : caches_)
        if (!cache.complete.empty())
            files.push_back(cache.target.file);
    return files;
}

std::vector<std::string> RunFiles::notes() const
{
    std::vector<std::string> notes;
    for (const Cache& cache : caches_)
        if (const std::string note = cache.writer->note(); !note.empty())
            notes.push_back(cache.target.file.string() + ": " + note);
    return notes;
}

std::vector<CachedCloth> RunFiles::cloths_to_check(const scenes::World& world) const
{
    const View<const scenes::ClothState> surfaces = world.simulated();
    std::vector<scene::Export> entries;
    for (const Cache& cache : caches_)
        entries.push_back(cache.target.entry);
    std::vector<CachedCloth> cloths;
    for (int surface = 0; surface < surfaces.size(); ++surface) {
        const std::optional<size_t> checked = export_to_check(job_.scene, entries, surface);
        if (!checked)
            continue;
        const Cache& cache = caches_[*checked];
        const scenes::ClothState& cloth = surfaces[surface];
        cloths.push_back({&cloth, cache.target.file, open_cloth(cache.complete, cache.target.entry, cloth)});
    }
    return cloths;
}

void RunFiles::publish()
{
    std::exception_ptr first_error;
    const auto attempt = [&](const std::function<void()>& move) {
        try {
            move();
        } catch (const std::exception&) {
            first_error = first_error ? first_error : std::current_exception();
        }
    };
    for (const std::filesystem::path& certificate : certificates_of(job_)) {
        std::error_code error;
        if (!std::filesystem::is_directory(certificate, error))
            std::filesystem::remove(certificate, error);
        if (error)
            throw DeviceError(certificate.string() + ": is of an earlier run and can't be removed (" +
                              error.message() + "); the new caches keep their partial names");
    }
    for (const StartMesh& mesh : meshes_)
        attempt([&] { exports::move_into_place(partial_beside(mesh.file), mesh.file); });
    for (Cache& cache : caches_)
        if (!cache.complete.empty())
            attempt([&] { cache.writer->publish(); });
    if (first_error)
        std::rethrow_exception(first_error);
}

} // namespace toile::app
