#include "apps/toile/drape/drape_progress.h"

#include <cstdio>

namespace toile::app {

namespace {

/// Time of a sample [s] after which the progress tells how much of it is done.
constexpr double kLongFrame = 2.0;

std::string time_text(const scenes::DrapeProgress& now)
{
    char text[64];
    if (now.duration > 0.0)
        std::snprintf(text, sizeof text, "%.2f s of %.2f s simulated", now.time, now.duration);
    else
        std::snprintf(text, sizeof text, "%.2f s simulated", now.time);
    return text;
}

} // namespace

void DrapeProgressLine::update(const scenes::DrapeProgress& now)
{
    last_ = now;
    frame_start_ = Clock::now();
    if (now.time == 0.0)
        return;
    std::string text = time_text(now);
    if (now.duration > 0.0)
        text += ", " + duration_text(now.seconds * (now.duration / now.time - 1.0)) + " left";
    progress_.tell(now.stage, text);
}

void DrapeProgressLine::update_world(const std::string& task, double fraction)
{
    if (last_.time == 0.0) {
        progress_.update(last_.stage.empty() ? task : last_.stage + ": " + task, fraction);
        return;
    }
    const std::chrono::duration<double> seconds = Clock::now() - frame_start_;
    if (seconds.count() > kLongFrame)
        progress_.tell(last_.stage, time_text(last_) + ", the next sample: " +
                                        std::to_string(int(100.0 * fraction)) + " %, " + task);
}

} // namespace toile::app
