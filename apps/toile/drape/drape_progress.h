#pragma once

#include <chrono>
#include <string>

#include "apps/toile/terminal/setup_progress.h"
#include "scenes/drape/drape.h"
#include "scenes/world/world_options.h"

namespace toile::app {

/// Progress line of a drape: the stage and its simulated time, and the time left in stages of a fixed
/// duration. While the scene of a stage loads, and in samples that take long, what is done.
class DrapeProgressLine {
public:
    /// @param progress  outlives this
    explicit DrapeProgressLine(SetupProgress& progress) : progress_(progress) {}

    /// A sample of a stage has ended, or its scene is about to load.
    void update(const scenes::DrapeProgress& now);
    /// Progress of the world that is being loaded or advanced.
    void update_world(const std::string& task, double fraction);

private:
    using Clock = std::chrono::steady_clock;

    SetupProgress& progress_;
    scenes::DrapeProgress last_;
    Clock::time_point frame_start_;
};

} // namespace toile::app
