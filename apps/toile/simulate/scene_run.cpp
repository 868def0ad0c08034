#include "apps/toile/simulate/scene_run.h"

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "apps/toile/caches/exports.h"
#include "apps/toile/simulate/start_text.h"
#include "apps/toile/simulate/unmet.h"
#include "apps/toile/terminal/command_line.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/quadrature/tables/table_store.h"
#include "export/cache_format.h"

namespace toile::app {

namespace {

std::string note_of(const StepReport& report)
{
    return std::to_string(report.iterations) + " iterations, " + std::to_string(report.contacts) +
           " contacts";
}

/// Time of a frame [s] after which the progress tells how much of it is done.
constexpr double kLongFrame = 2.0;

/// Reports the frame at which a run stopped early and lists the partial caches.
void explain_stop(int last_frame, const SceneRun::Outcome& outcome, RunFiles& files, const RunLog& log)
{
    const RunFiles::Partials partials = files.close();
    for (const std::filesystem::path& file : partials.files)
        log.file(file);
    const std::string reason = outcome.message.empty() ? "" : ": " + outcome.message;
    const std::string count = partials.frame_count == 0 ? "no" : std::to_string(partials.frame_count);
    if (last_frame == 0 && partials.frame_count == 0)
        log.error(outcome.word + " before the first frame" + reason + "; no frame was written");
    else
        log.error(outcome.word + " at frame " + std::to_string(last_frame) + reason + "; " + count +
                  (partials.frame_count <= 1 ? " frame is" : " frames are") + " in the partial caches");
}

/// Caches of a run that can be checked, as arguments.
std::string checked_files(const SceneJob& job)
{
    std::string files;
    for (const ExportFile& cache : caches_of(job))
        if (exports::features_of(exports::cache_format(cache.file)).read_back)
            files += (files.empty() ? "" : " ") + cache.file.string();
    return files;
}

/// Reports an exception of the work after the last frame. @return whether there was none
bool succeeds(const RunLog& log, const std::function<void()>& work)
{
    return run_and_report(log, [&] {
               work();
               return kExitOk;
           }) == kExitOk;
}

/// Writes a file under a partial name. @return none after reporting a failure
std::optional<StagedFile> stage(const std::filesystem::path& file, const std::filesystem::path& partial,
                                const std::string& content, const RunLog& log)
{
    std::optional<StagedFile> staged;
    const std::string_view piece = content;
    succeeds(log, [&] { staged.emplace(file, partial, std::span(&piece, 1)); });
    return staged;
}

/// @return false if there is none, or after reporting a failure
bool commit(std::optional<StagedFile>& staged, const RunLog& log)
{
    return staged && succeeds(log, [&] { staged->commit(); });
}

/// Also removes the report of an earlier run that did not finish.
bool deliver_report(const std::filesystem::path& file, std::optional<StagedFile>& staged, const RunLog& log)
{
    std::error_code missing;
    if (!is_stream(file))
        std::filesystem::remove(partial_beside(file), missing);
    return commit(staged, log);
}

} // namespace

SceneRun::SceneRun(const SceneJob& job, const RunSettings& settings, RunLog log,
                   const InterruptGuard* interrupt)
    : job_(job), no_check_(settings.no_check), log_(std::move(log)),
      progress_(log_.quiet(), log_.scene(), log_.use()), interrupt_(interrupt),
      subframes_(subframes_of(job.scene)), sampled_(with_subframes(job.scene, subframes_)),
      world_(sampled_, world_options(settings))
{
    if (const std::string text = start_text(world_.start(), job.scene); !text.empty())
        log_.note(text);
    world_.prepare();
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
        const bool goes_on = interrupt_ == nullptr || !interrupt_->requested();
        goes_on ? progress_.update("tables of cloth \"" + cloth + "\"", fraction) : progress_.stop();
        return goes_on;
    };
    options.progress = [this](const std::string& task, double fraction) { tell(task, fraction); };
    options.goes_on = [this] { return interrupt_ == nullptr || !interrupt_->requested(); };
    options.warn = [this](const std::string& text) { progress_.warn(text); };
    options.note = [this](const std::string& text) { progress_.note(text); };
    return options;
}

void SceneRun::tell(const std::string& task, double fraction)
{
    if (!frames_) {
        progress_.update(task, fraction);
        return;
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - frame_start_;
    if (seconds.count() > kLongFrame)
        frames_->update(world_.frame() / subframes_ + 1,
                        "the next: " + std::to_string(int(100.0 * fraction)) + " %, " + task);
}

int SceneRun::run(const InterruptGuard& interrupt)
{
    interrupt_ = &interrupt;
    RunFiles files(job_, world_, log_);
    int vertex_count = 0;
    for (const auto& cloth : world_.simulated())
        vertex_count += int(cloth.positions.size());
    RunReport report(job_.scene, vertex_count, world_.start(), world_.device());

    const Outcome outcome = run_or_stop(files, report);
    if (outcome.word == "complete")
        return publish(files, report);
    explain_stop(world_.frame() / subframes_, outcome, files, log_);
    if (!job_.report.empty())
        succeeds(log_, [&] {
            const std::filesystem::path file =
                is_stream(job_.report) ? job_.report : partial_beside(job_.report);
            write_atomically(file, report.to_json(outcome.word, world_.stages()));
            log_.result("the report of this run is " + file.string());
        });
    return kExitFailure;
}

/// Simulates the samples up to the next frame, and writes them.
StepReport SceneRun::advance_frame(RunFiles& files)
{
    StepReport total;
    for (int sample = 0; sample < subframes_; ++sample) {
        const StepReport step = world_.advance_frame();
        total.energy = 0.0; // these two are of the last sample
        total.contacts = 0;
        total.merge(step);
        if (step.status == StepReport::Status::NonFinite)
            break;
        files.write_sample(world_);
    }
    return total;
}

/// Settles and simulates to the last frame or to a failure.
/// @throws Cancelled at an interrupt, DeviceError if GPU or disk fail
SceneRun::Outcome SceneRun::run_frames(RunFiles& files, RunReport& report)
{
    if (const StepReport settled = world_.settle(); settled.status == StepReport::Status::NonFinite)
        return {"failed", settled.message};
    Unmet unmet(log_);
    const int count = job_.scene.frames;
    frames_ = std::unique_ptr<Progress>(new Progress(log_.progress("frame", count)));
    files.write_sample(world_);
    inverted_.push_back(world_.inverted_tets());
    frames_->update(1);
    for (int frame = 1; frame < count; ++frame) {
        frame_start_ = std::chrono::steady_clock::now();
        const StepReport step = advance_frame(files);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - frame_start_;
        report.add_frame(frame, step, seconds.count());
        unmet.add(frame, step);
        if (step.status == StepReport::Status::NonFinite)
            return {"failed", step.message};
        inverted_.push_back(world_.inverted_tets());
        unmet.add_inverted(frame, job_.scene.soft_bodies, inverted_.back());
        frames_->update(frame + 1, note_of(step));
    }
    files.complete();
    for (const std::string& note : files.notes())
        log_.note(note);
    unmet.sum_up(count);
    return {};
}

SceneRun::Outcome SceneRun::run_or_stop(RunFiles& files, RunReport& report)
{
    Outcome outcome;
    try {
        outcome = run_frames(files, report);
    } catch (const Cancelled&) {
        outcome.word = "interrupted";
    } catch (const std::exception& error) {
        outcome = {"failed", reason_of(error)};
    }
    frames_.reset();
    return outcome;
}

/// Certifies the complete caches. @return none after reporting an interrupt or a failure
std::optional<Certificate> SceneRun::check(const RunFiles& files) const
{
    std::optional<Certificate> certificate;
    const bool was_able = succeeds(log_, [&] {
        const ThreadLimit threads(job_.scene.solver.threads);
        certificate = certify(job_.scene, files.cloths_to_check(world_), {}, log_, *interrupt_);
        for (int frame = 0; certificate && frame < int(inverted_.size()); ++frame)
            certificate->add_inverted(frame, inverted_[size_t(frame)]);
    });
    if (was_able && !certificate)
        log_.error("interrupted while checking; the caches are complete, toile check " + checked_files(job_) +
                   " --scene " + job_.scene.source.string() + " --frames " +
                   std::to_string(job_.scene.frames) + " certifies them");
    return certificate;
}

/// Moves everything that the run made to its final names: the certificate last, so that it never lies beside
/// caches that it does not describe. What can't be delivered does not keep back the rest.
int SceneRun::publish(RunFiles& files, const RunReport& report) const
{
    // Have everything ready under partial names before the first file of an earlier run is replaced. No lock
    // keeps another run from naming the same report.
    const std::filesystem::path certificate_name = job_.folder / kCertificateName;
    std::optional<StagedFile> staged_report, staged_certificate;
    if (!job_.report.empty())
        staged_report = stage(job_.report, unique_partial(job_.report),
                              report.to_json("complete", world_.stages()), log_);
    const std::optional<Certificate> certificate = no_check_ ? std::nullopt : check(files);
    if (certificate)
        staged_certificate =
            stage(certificate_name, partial_beside(certificate_name), to_json(*certificate), log_);

    if (!succeeds(log_, [&] { files.publish(); }))
        return kExitFailure;
    for (const std::filesystem::path& cache : files.completed())
        log_.file(cache);
    for (const std::string& why : files.undelivered())
        log_.error(why);
    const bool is_whole = (job_.report.empty() || deliver_report(job_.report, staged_report, log_)) &&
                          files.undelivered().empty();
    if (no_check_)
        return is_whole ? kExitOk : kExitFailure;
    if (!commit(staged_certificate, log_))
        return kExitFailure;
    log_.file(certificate_name);
    const int code = conclude(*certificate, certificate_name, log_);
    return is_whole ? code : int(kExitFailure);
}

} // namespace toile::app
