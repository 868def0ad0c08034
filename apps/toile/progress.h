#pragma once

#include <chrono>
#include <string>

namespace toile {

/// Whether other threads write to stderr meanwhile: then no line is rewritten, on a terminal neither.
enum class Stderr { Own, Shared };

/// Tells on stderr how far a run is and how long it will take: one line that is rewritten on a terminal, now
/// and then a new line in a log file, nothing when quiet.
class Progress {
public:
    Progress(std::string what, int total, bool quiet, Stderr use = Stderr::Own);
    /// Ends a rewritten line, so that what follows starts on its own.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// @param done  items finished so far
    /// @param note  shown behind, e.g. the solver's iterations
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

} // namespace toile
