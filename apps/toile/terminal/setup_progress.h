#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "apps/toile/terminal/progress.h"

namespace toile::app {

/// Reports long work before the first frame on stderr, like Progress: one line rewritten on a terminal,
/// occasional lines in a log file, nothing if quiet. Work of less than half a second leaves no line. Calls
/// may come from several threads.
class SetupProgress {
public:
    /// @param scene  prefix of every text; empty for a single scene
    explicit SetupProgress(bool quiet, const std::string& scene = "", Stderr use = Stderr::Exclusive);
    ~SetupProgress();
    SetupProgress(const SetupProgress&) = delete;
    SetupProgress& operator=(const SetupProgress&) = delete;

    /// @param task      what is done: "tables of cloth "skirt""
    /// @param fraction  finished [0, 1]; after 1 the next call begins anew
    void update(const std::string& task, double fraction);

    /// Tells the state of work whose end is not known: "sew: 0.53 s simulated".
    void tell(const std::string& task, const std::string& state);

    /// Prints "toile: warning: ..." on a line of its own, quiet or not.
    void warn(const std::string& text);

    /// Prints "toile: ..." on a line of its own, unless quiet.
    void note(const std::string& text);

    /// Ends the line after the work was cancelled.
    void stop();

private:
    using Clock = std::chrono::steady_clock;

    void begin(const std::string& task, double fraction, Clock::time_point now);
    bool is_due(Clock::time_point now) const;
    void end_line();
    void erase_line();
    void print(const std::string& text);

    std::mutex mutex_;
    std::string prefix_;
    bool quiet_, rewrites_;
    bool line_open_ = false, is_working_ = false;
    std::string task_;
    double first_fraction_ = 0.0;
    Clock::time_point start_, last_line_;
};

/// E.g. "3 s" or, from a minute on, "1:15".
std::string duration_text(double seconds);

} // namespace toile::app
