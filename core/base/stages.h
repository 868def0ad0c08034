#pragma once

#include <chrono>
#include <map>
#include <string>
#include <string_view>

namespace toile {

/// Call counts and wall time of named stages: what a run did, how often and for how long. An absent name says
/// what it skipped.
///
/// A Stages object records all StageScope and parallel_for calls of a thread while it is active there. Two
/// worlds stepped on two threads do not see each other. With none active nothing is recorded.
class Stages {
public:
    struct Entry {
        long calls = 0;
        double seconds = 0.0;      ///< [s] wall time, nested stages included
        double self_seconds = 0.0; ///< [s] without nested stages; adds up to the outermost stages' time
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

    /// @param self_seconds  part of `seconds` outside of nested stages
    void add(std::string_view name, double seconds, double self_seconds);

    /// Calls of a stage so far; 0 if it never ran.
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
    double nested_before_; ///< [s] of stages that ended in the enclosing scope before this one
    Clock::time_point start_;
};

} // namespace toile
