#pragma once

#include <chrono>
#include <mutex>
#include <string>

#include "apps/toile/progress.h"

namespace toile {

/// Tells on stderr how far the quadrature tables of a cloth are, in the manner of Progress: one line that is
/// rewritten on a terminal, now and then a new line in a log file, nothing when quiet or when it takes less
/// than half a second. Calls may come from several threads.
class TableProgress {
public:
    /// @param scene  begins every text; empty where a single scene runs
    explicit TableProgress(bool quiet, const std::string& scene = "", Stderr use = Stderr::Own);
    ~TableProgress();
    TableProgress(const TableProgress&) = delete;
    TableProgress& operator=(const TableProgress&) = delete;

    /// @param share  finished [0, 1]; at 1 the next call begins anew
    void update(const std::string& cloth, double share);

    /// Prints "toile: warning: ..." on a line of its own, quiet or not.
    void warn(const std::string& text);

    /// The building was cancelled: what is printed next starts on a line of its own.
    void stop();

private:
    using Clock = std::chrono::steady_clock;

    void end_line();
    void print(const std::string& text);

    std::mutex mutex_;
    std::string prefix_;
    bool quiet_, rewrites_;
    bool line_open_ = false, is_building_ = false;
    std::string cloth_;
    double first_share_ = 0.0;
    Clock::time_point start_, last_line_;
};

/// E.g. "3 s" or, from a minute on, "1:15".
std::string duration_text(double seconds);

} // namespace toile
