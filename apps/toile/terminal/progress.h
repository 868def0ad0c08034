#pragma once

#include <chrono>
#include <string>

namespace toile::app {

/// Whether other threads write to stderr too: then no line is rewritten, even on a terminal.
enum class Stderr { Exclusive, Shared };

/// Reports the progress of a run and its remaining time on stderr: one line rewritten on a terminal,
/// occasional lines in a log file, nothing if quiet.
class Progress {
public:
    Progress(std::string what, int total, bool quiet, Stderr use = Stderr::Exclusive);
    /// Ends a rewritten line, so that the next text starts on a new line.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// @param done  items finished so far
    /// @param note  appended, e.g. the solver's iterations
    void update(int done, const std::string& note = "");

private:
    using Clock = std::chrono::steady_clock;

    std::string what_;
    int total_;
    bool quiet_;
    bool rewrites_;
    bool line_open_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_line_ = start_;
};

/// 75 s as "1:15", 3675 s as "1:01:15".
std::string clock_text(double seconds);

} // namespace toile::app
