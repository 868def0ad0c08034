#include "apps/toile/terminal/setup_progress.h"

#include <cmath>
#include <cstdio>

#include <unistd.h>

namespace toile::app {

namespace {

/// Work that takes less leaves no line.
constexpr std::chrono::milliseconds kSilence(500);

/// Finished fraction from which the remaining time is told.
constexpr double kMinFraction = 0.01;

/// Intervals between two lines of a log file, and between two updates of a terminal's line.
constexpr std::chrono::seconds kLogInterval(10);
constexpr std::chrono::milliseconds kTerminalInterval(100);

} // namespace

SetupProgress::SetupProgress(bool quiet, const std::string& scene, Stderr use)
    : prefix_(scene.empty() ? "" : scene + ": "), quiet_(quiet),
      rewrites_(use == Stderr::Exclusive && ::isatty(STDERR_FILENO) == 1)
{
}

SetupProgress::~SetupProgress() { end_line(); }

void SetupProgress::update(const std::string& task, double fraction)
{
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    begin(task, fraction, now);
    const bool is_finished = fraction >= 1.0;
    const double seconds = std::chrono::duration<double>(now - start_).count();
    if (!quiet_ && (is_finished ? now - start_ >= kSilence : is_due(now))) {
        last_line_ = now;
        std::string text = prefix_ + task + ": " + std::to_string(int(100.0 * fraction)) + " %";
        if (is_finished)
            text += ", done in " + duration_text(seconds);
        else if (fraction > first_fraction_ + kMinFraction)
            text += ", " + duration_text(seconds * (1.0 - fraction) / (fraction - first_fraction_)) + " left";
        print(text);
    }
    if (is_finished) {
        is_working_ = false;
        now - start_ < kSilence ? erase_line() : end_line();
    }
}

void SetupProgress::tell(const std::string& task, const std::string& state)
{
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    begin(task, 0.0, now);
    if (quiet_ || !is_due(now))
        return;
    last_line_ = now;
    print(prefix_ + task + ": " + state);
}

/// Notes the begin of a task unless it is under way.
void SetupProgress::begin(const std::string& task, double fraction, Clock::time_point now)
{
    if (is_working_ && task == task_)
        return;
    is_working_ = true;
    task_ = task;
    first_fraction_ = fraction;
    start_ = now;
    last_line_ = rewrites_ ? now - kTerminalInterval : now + kSilence - kLogInterval;
}

bool SetupProgress::is_due(Clock::time_point now) const
{
    return now - last_line_ >= (rewrites_ ? Clock::duration(kTerminalInterval) : kLogInterval);
}

void SetupProgress::stop()
{
    const std::lock_guard lock(mutex_);
    is_working_ = false;
    end_line();
}

void SetupProgress::warn(const std::string& text)
{
    const std::lock_guard lock(mutex_);
    end_line();
    std::fprintf(stderr, "toile: warning: %s%s\n", prefix_.c_str(), text.c_str());
}

void SetupProgress::note(const std::string& text)
{
    const std::lock_guard lock(mutex_);
    if (quiet_)
        return;
    end_line();
    std::fprintf(stderr, "toile: %s%s\n", prefix_.c_str(), text.c_str());
}

void SetupProgress::end_line()
{
    if (line_open_)
        std::fputc('\n', stderr);
    line_open_ = false;
}

void SetupProgress::erase_line()
{
    if (line_open_)
        std::fputs("\r\033[K", stderr);
    line_open_ = false;
}

void SetupProgress::print(const std::string& text)
{
    std::fprintf(stderr, rewrites_ ? "\r%s\033[K" : "%s\n", text.c_str());
    std::fflush(stderr);
    line_open_ = rewrites_;
}

std::string duration_text(double seconds)
{
    return seconds < 59.5 ? std::to_string(std::lround(seconds)) + " s" : clock_text(seconds);
}

} // namespace toile::app
