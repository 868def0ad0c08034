#include "scenes/drape/drape_watch.h"

#include <algorithm>
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

void DrapeWatch::run(const std::function<void()>& work, DrapeResult& result) const
{
    const Cancellation::Scope cancellation(options_.goes_on);
    try {
        work();
    } catch (const Cancelled&) {
        if (!is_out_of_time())
            throw;
        end_early(result);
    }
    for (size_t g = 0; g < state_.size(); ++g)
        result.garments[g].surface = state_[g];
}

void DrapeWatch::begin(const std::string& stage, std::vector<GarmentSurface> surfaces, double frame)
{
    stage_ = stage;
    stage_start_ = Clock::now();
    frame_ = frame;
    frames_ = stage_steps_ = 0;
    state_ = std::move(surfaces);
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
    for (size_t g = 0; g < state_.size(); ++g)
        state_[g].mesh.positions = world.cloths()[g].positions;
    tell(frames_ * frame_, duration);
    return report;
}

int DrapeWatch::take_steps() { return std::exchange(steps_, 0); }

bool DrapeWatch::is_out_of_time() const
{
    return std::chrono::duration<double>(Clock::now() - start_).count() > settings_.time_limit;
}

/// Class by the stage under way, which is added to those of its garment.
void DrapeWatch::end_early(DrapeResult& result) const
{
    const bool has_begun = !stage_.empty() && state_.size() == result.garments.size();
    result.message = "the time limit of " + short_text(settings_.time_limit) + " s ended it ";
    if (!has_begun) {
        result.outcome = DrapeOutcome::Meshing;
        result.message += "before it was sewn";
        return;
    }
    result.outcome = stage_ == "fold" || stage_ == "sew" ? DrapeOutcome::Tangled : DrapeOutcome::NotAtRest;
    result.message += "in stage " + place() + ", after " + short_text(frames_ * frame_) + " s of its motion";
    result.garments.back().stages.push_back(
        {stage_, seconds_of_stage(), frames_, int(state_.back().mesh.positions.size()), stage_steps_});
}

std::string DrapeWatch::place() const
{
    if (settings_.garments.size() == 1)
        return stage_;
    return settings_.garments[state_.size() - 1].name + ", " + stage_;
}

void DrapeWatch::tell(double time, double duration) const
{
    if (settings_.progress)
        settings_.progress({place(), time, duration, seconds_of_stage()});
}

double DrapeWatch::seconds_of_stage() const
{
    return std::chrono::duration<double>(Clock::now() - stage_start_).count();
}

} // namespace toile::scenes
