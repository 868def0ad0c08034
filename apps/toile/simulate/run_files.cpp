#include "apps/toile/simulate/run_files.h"

#include <algorithm>
#include <functional>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "export/binary_file.h"
#include "export/cache_format.h"

namespace toile::app {

RunFiles::RunFiles(const SceneJob& job, const scenes::World& world, const RunLog& log) : job_(job)
{
    for (const std::filesystem::path& folder : output_folders_of(job))
        locks_.all.emplace_back(folder, [&](const std::string& text) { log.note("warning: " + text); });
    for (const SurfaceFile& cache : caches_of(job)) {
        const scenes::ClothState& state = world.surfaces()[cache.surface];
        exports::CacheLayout layout = exports::cache_layout(state.file_mesh(), job.scene.frames);
        layout.fps = job.scene.fps;
        caches_.push_back({cache,
                           &state,
                           std::make_unique<exports::AsyncCacheWriter>(make_cache_writer(cache.file, layout)),
                           {}});
    }
    for (const SurfaceFile& mesh : start_meshes_of(job)) {
        const scenes::ClothState& state = world.surfaces()[mesh.surface];
        meshes_.push_back({mesh.file, state.file_mesh()});
        meshes_.back().mesh.positions = state.to_file(state.positions);
    }
}

void RunFiles::write_start_meshes()
{
    for (StartMesh& mesh : meshes_) {
        write_obj(partial_beside(mesh.file), mesh.mesh);
        mesh.mesh = {};
    }
}

void RunFiles::write_frame(const scenes::World& world)
{
    if (!std::exchange(has_frames_, true))
        write_start_meshes();
    if (world.device() == nullptr) {
        for (Cache& cache : caches_) {
            const std::vector<Vec3>& x = world.surfaces()[cache.target.surface].positions;
            if (cache.state->has_file_order())
                cache.writer->write(world.frame(), cache.state->to_file(x));
            else
                cache.writer->write(world.frame(), x);
        }
        return;
    }
    const std::shared_ptr<const scenes::Snapshot> snapshot = world.snapshot();
    for (Cache& cache : caches_)
        cache.writer->write_later(world.frame(),
                                  [snapshot, state = cache.state, surface = cache.target.surface] {
                                      return state->to_file(snapshot->positions(surface));
                                  });
}

RunFiles::Partials RunFiles::close()
{
    Partials partials;
    for (Cache& cache : caches_) {
        const int written = cache.writer->close();
        std::error_code missing;
        if (written == 0 || !std::filesystem::exists(cache.writer->partial(), missing))
            continue;
        partials.frame_count = std::max(partials.frame_count, written);
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
            if (exports::is_read_back(exports::cache_format(cache.target.file)))
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
    std::vector<CachedCloth> cloths;
    for (const Cache& cache : caches_) {
        const scenes::ClothState* cloth = &world.surfaces()[cache.target.surface];
        if (exports::is_read_back(exports::cache_format(cache.target.file)) &&
            std::none_of(cloths.begin(), cloths.end(),
                         [&](const CachedCloth& other) { return other.cloth == cloth; }))
            cloths.push_back({cloth, cache.target.file, cache.complete});
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
