#include "apps/toile/terminal/progress.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include <unistd.h>

namespace toile::app {

namespace {

/// Minimum times between lines of a log file, and between updates of a terminal's line, except the last.
constexpr std::chrono::seconds kLogInterval(10);
constexpr std::chrono::milliseconds kTerminalInterval(100);

} // namespace

Progress::Progress(std::string what, int total, bool quiet, Stderr use)
    : what_(std::move(what)), total_(total), quiet_(quiet),
      rewrites_(use == Stderr::Exclusive && ::isatty(STDERR_FILENO) == 1)
{
}

Progress::~Progress()
{
    if (line_open_)
        std::fputc('\n', stderr);
}

void Progress::update(int done, const std::string& note)
{
    const Clock::time_point now = Clock::now();
    const Clock::duration interval = rewrites_ ? Clock::duration(kTerminalInterval) : kLogInterval;
    const bool due = done == total_ || now - last_line_ >= interval;
    if (quiet_ || !due)
        return;
    last_line_ = now;

    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double per_item = done > 0 ? elapsed / done : 0.0;
    char text[256];
    std::snprintf(text, sizeof text, "%s %d/%d (%d %%)  %.3g s each  ETA %s%s%s", what_.c_str(), done, total_,
                  int(100.0 * done / total_), per_item, clock_text(per_item * (total_ - done)).c_str(),
                  note.empty() ? "" : "  ", note.c_str());
    // Return to the start of the line and clear the rest of a longer text.
    std::fprintf(stderr, rewrites_ ? "\r%s\033[K" : "%s\n", text);
    std::fflush(stderr);
    line_open_ = rewrites_;
}

std::string clock_text(double seconds)
{
    const long total = std::lround(seconds);
    char text[32];
    if (total >= 3600)
        std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", total / 3600, total / 60 % 60, total % 60);
    else
        std::snprintf(text, sizeof text, "%ld:%02ld", total / 60, total % 60);
    return text;
}

} // namespace toile::app
