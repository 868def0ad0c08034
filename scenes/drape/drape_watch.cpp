#include "scenes/drape/drape_watch.h"

#include <set>
#include <utility>

#include "core/base/cancellation.h"
#include "core/base/error.h"
#include "core/base/number.h"

namespace toile::scenes {

DrapeWatch::DrapeWatch(const DrapeSettings& settings, const WorldOptions& options)
    : settings_(settings), options_(options)
{
    // The meshes of the stages are the drape's own; a body is loaded for every stage.
    options_.warn = [asked = options.warn, own = settings.folder.string(),
                     told = std::set<std::string>()](const std::string& text) mutable {
        if (asked && text.find(own) == std::string::npos && told.insert(text).second)
            asked(text);
    };
    options_.goes_on = [this, asked = options.goes_on] { return (!asked || asked()) && !is_out_of_time(); };
}

DrapeResult DrapeWatch::run(const std::function<DrapeResult()>& work, DrapeResult& unfinished) const
{
    const Cancellation::Scope cancellation(options_.goes_on);
    DrapeResult result;
    try {
        result = work();
    } catch (const Cancelled&) {
        if (!is_out_of_time())
            throw;
        result = std::move(unfinished);
        end_early(result);
    }
    if (result.surface.mesh.positions.empty() || result.outcome == DrapeOutcome::Solver)
        result.surface = state_;
    return result;
}

void DrapeWatch::begin(const std::string& stage, GarmentSurface surface, double frame)
{
    stage_ = stage;
    stage_start_ = Clock::now();
    frame_ = frame;
    frames_ = stage_steps_ = 0;
    state_ = std::move(surface);
    tell(0.0, 0.0);
}

StepReport DrapeWatch::advance(World& world, double duration)
{
    StepReport report = world.advance_frame();
    ++frames_;
    stage_steps_ += report.steps;
    steps_ += report.steps;
    if (report.status == StepReport::Status::NonFinite)
        return report;
    const std::vector<Vec3>& x = world.cloths()[0].positions;
    state_.mesh.positions.assign(x.begin(), x.end());
    tell(frames_ * frame_, duration);
    return report;
}

int DrapeWatch::take_steps() { return std::exchange(steps_, 0); }

bool DrapeWatch::is_out_of_time() const
{
    return std::chrono::duration<double>(Clock::now() - start_).count() > settings_.time_limit;
}

/// Class by the stage under way, which is added to the stages.
void DrapeWatch::end_early(DrapeResult& result) const
{
    if (stage_.empty())
        result.outcome = DrapeOutcome::Meshing;
    else
        result.outcome = stage_ == "sew" ? DrapeOutcome::Tangled : DrapeOutcome::NotAtRest;
    result.message = "the time limit of " + short_text(settings_.time_limit) + " s ended it ";
    if (stage_.empty()) {
        result.message += "before it was sewn";
        return;
    }
    result.message += "in stage " + stage_ + ", after " + short_text(frames_ * frame_) + " s of its motion";
    result.stages.push_back(
        {stage_, seconds_of_stage(), frames_, int(state_.mesh.positions.size()), stage_steps_});
}

void DrapeWatch::tell(double time, double duration) const
{
    if (settings_.progress)
        settings_.progress({stage_, time, duration, seconds_of_stage()});
}

double DrapeWatch::seconds_of_stage() const
{
    return std::chrono::duration<double>(Clock::now() - stage_start_).count();
}

} // namespace toile::scenes
