#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

namespace toile {

/// Call counts and wall time of named stages: what a run did, how often, for how long, and, by the names
/// that are absent, what it skipped.
///
/// A Stages object records whatever StageScope and parallel_for run while it is active on that thread; two
/// worlds stepped on two threads do not see each other. With none active nothing is recorded.
class Stages {
public:
    struct Entry {
        long calls = 0;
        double seconds = 0.0;     ///< [s] wall time, nested stages included
        double own_seconds = 0.0; ///< [s] without them: these add up to the time of the outermost stages
    };

    /// Makes `stages` the recorder of this thread until the end of the scope.
    class Activate {
    public:
        explicit Activate(Stages& stages);
        ~Activate();
        Activate(const Activate&) = delete;
        Activate& operator=(const Activate&) = delete;

    private:
        Stages* previous_;
    };

    /// The recorder active on this thread, or null.
    static Stages* active();

    /// @param own_seconds  of `seconds`, those outside of nested stages
    void add(std::string_view name, double seconds, double own_seconds);

    /// Calls of a stage so far; 0 for one that never ran.
    long calls(std::string_view name) const;
    double seconds(std::string_view name) const;
    const std::map<std::string, Entry, std::less<>>& entries() const { return entries_; }
    void clear() { entries_.clear(); }

private:
    std::map<std::string, Entry, std::less<>> entries_;
};

/// Counts and times the enclosing block as one call of the stage `name`.
class StageScope {
public:
    explicit StageScope(std::string_view name);
    ~StageScope();
    StageScope(const StageScope&) = delete;
    StageScope& operator=(const StageScope&) = delete;

private:
    using Clock = std::chrono::steady_clock;
    std::string_view name_;
    double nested_before_; ///< [s] of the enclosing scope's nested stages, before this one
    Clock::time_point start_;
};

} // namespace toile
