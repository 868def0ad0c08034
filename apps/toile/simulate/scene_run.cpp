#include "apps/toile/simulate/scene_run.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "apps/toile/check/certify.h"
#include "apps/toile/simulate/run_report.h"
#include "apps/toile/simulate/start_text.h"
#include "apps/toile/simulate/unmet.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/exports.h"
#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/mesh/obj.h"
#include "core/quadrature/tables/table_store.h"
#include "export/async_cache_writer.h"

namespace toile::app {

namespace {

/// A cache being written and the cloth or solid that it stores.
struct OpenCache {
    std::filesystem::path file;
    int cloth;
    const scenes::ClothState* state; ///< of the world
    std::unique_ptr<exports::AsyncCacheWriter> writer;
};

std::vector<OpenCache> open_caches(const scenes::Scene& scene, const scenes::World& world,
                                   const std::filesystem::path& folder)
{
    std::vector<OpenCache> caches;
    for (const scene::Export& entry : exports_of(scene)) {
        const int cloth = surface_index(scene, entry.cloth);
        const scenes::ClothState& state = world.surfaces()[cloth];
        exports::CacheLayout layout = exports::cache_layout(state.file_mesh(), scene.frames);
        layout.fps = scene.fps;
        const std::filesystem::path file = folder / entry.file;
        caches.push_back({file, cloth, &state,
                          std::make_unique<exports::AsyncCacheWriter>(make_cache_writer(file, layout))});
    }
    return caches;
}

void write_frame(const scenes::World& world, std::vector<OpenCache>& caches)
{
    if (world.device() == nullptr) {
        for (OpenCache& cache : caches)
            cache.writer->write(world.frame(), cache.state->to_file(world.surfaces()[cache.cloth].positions));
        return;
    }
    const std::shared_ptr<const scenes::Snapshot> snapshot = world.snapshot();
    for (OpenCache& cache : caches)
        cache.writer->write_later(world.frame(), [snapshot, state = cache.state, surface = cache.cloth] {
            return state->to_file(snapshot->positions(surface));
        });
}

/// Writes the start mesh next to a cache. PC2 and MDD store positions only. No mesh is written if an OBJ of
/// that name is among the caches.
void write_start_mesh(const scenes::World& world, const OpenCache& cache,
                      const std::vector<OpenCache>& caches)
{
    const std::filesystem::path file = std::filesystem::path(cache.file).replace_extension(".obj");
    if (std::any_of(caches.begin(), caches.end(), [&](const OpenCache& other) { return other.file == file; }))
        return;
    ObjMesh mesh = cache.state->file_mesh();
    mesh.positions = cache.state->to_file(world.surfaces()[cache.cloth].positions);
    write_obj(file, mesh);
}

std::string note_of(const StepReport& report)
{
    return std::to_string(report.iterations) + " iterations, " + std::to_string(report.contacts) +
           " contacts";
}

/// End of a run.
struct Outcome {
    std::string word = "complete"; ///< or "interrupted", "failed"
    std::string message;           ///< reason of a failure
};

/// Settles and simulates to the last frame, to an interrupt, or to a failure.
/// @throws Cancelled if interrupted while tables are built, DeviceError if GPU or disk fail
void run_frames(scenes::World& world, const scenes::Scene& scene, std::vector<OpenCache>& caches,
                RunReport& report, const InterruptGuard& interrupt, const RunLog& log, Outcome& outcome)
{
    world.settle();
    Unmet unmet(log);
    Progress progress = log.progress("frame", scene.frames);
    write_frame(world, caches);
    progress.update(1);
    while (world.frame() + 1 < scene.frames) {
        if (interrupt.requested()) {
            outcome.word = "interrupted";
            return;
        }
        const auto start = std::chrono::steady_clock::now();
        const StepReport step = world.advance_frame();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
        report.add_frame(world.frame(), step, seconds.count());
        unmet.add(world.frame(), step);
        if (step.status == StepReport::Status::NonFinite) {
            outcome.word = "failed";
            outcome.message = step.message;
            return;
        }
        write_frame(world, caches);
        progress.update(world.frame() + 1, note_of(step));
    }
    unmet.sum_up(scene.frames);
}

Outcome run_or_stop(scenes::World& world, const scenes::Scene& scene, std::vector<OpenCache>& caches,
                    RunReport& report, const InterruptGuard& interrupt, const RunLog& log)
{
    Outcome outcome;
    try {
        run_frames(world, scene, caches, report, interrupt, log, outcome);
    } catch (const Cancelled&) {
        outcome.word = "interrupted";
    } catch (const DeviceError& error) {
        outcome.word = "failed";
        outcome.message = error.what();
    }
    return outcome;
}

/// Reports the frame at which a run stopped early and lists the partial caches; deletes those without a
/// frame. They lack positions that a failed GPU did not send.
void explain_stop(int last_frame, const Outcome& outcome, std::vector<OpenCache>& caches, const RunLog& log)
{
    int max_written = 0;
    for (OpenCache& cache : caches) {
        const int written = cache.writer->close();
        const std::filesystem::path partial = cache.writer->partial();
        cache.writer.reset();
        max_written = std::max(max_written, written);
        std::error_code gone_already;
        if (written == 0)
            std::filesystem::remove_all(partial, gone_already);
        else
            log.file(partial);
    }
    const std::string reason = outcome.message.empty() ? "" : ": " + outcome.message;
    if (max_written == 0)
        log.error(outcome.word + " before the first frame" + reason + "; no frame was written");
    else
        log.error(outcome.word + " at frame " + std::to_string(last_frame) + reason + "; " +
                  std::to_string(max_written) + (max_written == 1 ? " frame is" : " frames are") +
                  " in the partial caches");
}

/// Complete caches on disk with their cloths, one per cloth.
std::vector<CachedCloth> cloths_to_check(const scenes::World& world, const std::vector<OpenCache>& caches)
{
    std::vector<CachedCloth> cloths;
    for (const OpenCache& cache : caches) {
        const scenes::ClothState* cloth = &world.surfaces()[cache.cloth];
        if (std::none_of(cloths.begin(), cloths.end(),
                         [&](const CachedCloth& other) { return other.cloth == cloth; }))
            cloths.push_back({cloth, cache.file});
    }
    return cloths;
}

/// Certifies the caches on disk.
int check_caches(const scenes::World& world, const scenes::Scene& scene, const std::vector<OpenCache>& caches,
                 const std::filesystem::path& folder, const InterruptGuard& interrupt, const RunLog& log)
{
    const ThreadLimit threads(scene.solver.threads);
    std::optional<Certificate> certificate;
    {
        Progress progress = log.progress("check", scene.frames);
        certificate = certify(scene, cloths_to_check(world, caches), {}, [&](int done, int) {
            progress.update(done);
            return !interrupt.requested();
        });
    }
    if (!certificate) {
        log.error("interrupted while checking; the caches are complete, toile check " + folder.string() +
                  " --scene " + scene.source.string() + " certifies them");
        return kExitFailure;
    }
    const std::filesystem::path file = folder / kCertificateName;
    log.file(file);
    return conclude(*certificate, file, log);
}

} // namespace

SceneRun::SceneRun(const SceneJob& job, const RunSettings& settings, RunLog log)
    : job_(job), no_check_(settings.no_check), log_(std::move(log)),
      progress_(log_.quiet(), log_.scene(), log_.use()), world_(job.scene, world_options(settings))
{
    if (const std::string text = start_text(world_.start(), job.scene); !text.empty())
        log_.note(text);
}

scenes::WorldOptions SceneRun::world_options(const RunSettings& settings)
{
    scenes::WorldOptions options;
    options.backend = settings.backend;
    options.device = settings.device;
    options.baselines = settings.baselines;
    if (settings.no_cache)
        options.tables = std::make_shared<TableStore>();
    options.building = [this](const std::string& cloth, double fraction) {
        const bool goes_on = !interrupt_->requested();
        goes_on ? progress_.update("tables of cloth \"" + cloth + "\"", fraction) : progress_.stop();
        return goes_on;
    };
    options.progress = [this](const std::string& task, double fraction) { progress_.update(task, fraction); };
    options.warn = [this](const std::string& text) { progress_.warn(text); };
    return options;
}

int SceneRun::run(const InterruptGuard& interrupt)
{
    interrupt_ = &interrupt;
    try {
        if (interrupt.requested())
            throw Cancelled("interrupted while the scene was loaded");
        world_.prepare();
    } catch (const Cancelled&) {
        log_.error("interrupted before the first frame; nothing was written");
        return kExitFailure;
    }
    return run_into_caches(interrupt);
}

int SceneRun::run_into_caches(const InterruptGuard& interrupt)
{
    std::vector<OpenCache> caches = open_caches(job_.scene, world_, job_.folder);

    int vertex_count = 0;
    for (const auto& cloth : world_.surfaces())
        vertex_count += int(cloth.positions.size());
    RunReport report(job_.scene, vertex_count, world_.start(), world_.device());
    for (const OpenCache& cache : caches)
        write_start_mesh(world_, cache, caches);

    const Outcome outcome = run_or_stop(world_, job_.scene, caches, report, interrupt, log_);
    const bool is_complete = outcome.word == "complete";
    if (!is_complete)
        explain_stop(world_.frame(), outcome, caches, log_);
    if (!job_.report.empty())
        report.write(job_.report, outcome.word, world_.stages());
    if (!is_complete)
        return kExitFailure;
    for (OpenCache& cache : caches) {
        cache.writer->finish();
        log_.file(cache.file);
    }
    // A certificate of an earlier run does not apply to these caches.
    std::error_code ignored;
    std::filesystem::remove(job_.folder / kCertificateName, ignored);
    return no_check_ ? int(kExitOk) : check_caches(world_, job_.scene, caches, job_.folder, interrupt, log_);
}

} // namespace toile::app
