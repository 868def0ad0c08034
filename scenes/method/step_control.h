#pragma once

#include <functional>

#include "core/pd/step/step_report.h"

namespace toile::scenes {

/// Chooses the lengths of a scene's time steps: a fixed number per sample, or by what moves.
///
/// All lengths are ticks times a power of two, and a step of n ticks begins at a multiple of n ticks. A step
/// chosen by what moves is halved while its estimated error exceeds the one allowed, doubled while it is a
/// tenth of that, and shortened where bodies are fast. One whose error is ten times the one allowed, such as
/// that in which something falls to the floor, is made again where that is possible, unless it is short
/// already.
class StepControl {
public:
    /// Longest step by what moves [s]. A sample is divided evenly, so it is an upper bound.
    static constexpr double kLongest = 1.0 / 60.0;
    /// A sixteenth of the longest step is the shortest, or one tick where its error is far too large.
    static constexpr int kTicksOfLongest = 64;

    static StepControl fixed(double sample_duration, int steps);

    /// @param error  [m] allowed RMS error of a step by itself
    static StepControl by_motion(double sample_duration, double error);

    double tick() const { return tick_; } ///< [s]
    int ticks_of_sample() const { return ticks_of_sample_; }
    int longest() const { return longest_; } ///< [ticks]

    /// Shortest step but where the error is far too large [s].
    double shortest() const;

    /// Length of the first step, for preparations [ticks].
    int first() const { return length_; }

    /// Chooses the step that begins `begin` ticks after a sample, or before time 0 in a number that is a
    /// multiple of longest().
    /// @param motion  largest of a body in a step of that many ticks, see BodyMotion::motion_to [-]; not
    ///                called for fixed steps
    /// @return its length [ticks]
    int choose(int begin, const std::function<double(int ticks)>& motion);

    /// RMS error [m] from which on the step that choose() chose is better made again, shorter; kAnyStepError:
    /// none.
    double max_error() const;

    /// Learns from a step that choose() chose, taken or refused.
    void observe(const StepReport& step);

private:
    StepControl(double tick, int ticks_of_sample, int longest, int length, double error)
        : tick_(tick), ticks_of_sample_(ticks_of_sample), longest_(longest), length_(length), error_(error)
    {
    }

    double tick_;
    int ticks_of_sample_, longest_;
    int length_;     ///< [ticks] that the error allows
    double error_;   ///< [m] 0: fixed steps
    int chosen_ = 0; ///< [ticks]
};

} // namespace toile::scenes
