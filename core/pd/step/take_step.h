#pragma once

#include "core/pd/step/step_space.h"

namespace toile {

/// Limits of the minimisations of a step.
struct StepLimits {
    int max_iterations = 50; ///< outer iterations per minimisation
    int max_passes = 3;      ///< see StepPasses

    /// [m/s] Newton::Settings::tolerance where cloth touches; 0: other methods. Calm cloth needs less:
    /// nothing hangs in the air that should have slid.
    double speed_tolerance = 0.0;
    static constexpr double kCalm = 3.0; ///< factor for calm cloth [-]
    bool begins_by_local_global = true;  ///< Newton::Settings
};

/// Maximum number of corrections at the end of a step, if keep_apart() moves cloth far in each. A walking
/// skirt needs more than four and at most seven (docs/journal/self_collision.md).
inline constexpr int kMaxCorrections = 8;

/// Advances a body by one step: prediction, minimisations with a search for contact after each, and the
/// corrections of what they do not guarantee. A step whose energy is not finite, or whose error is too large,
/// leaves the body unchanged.
/// @param patience  of the body, from step to step
StepReport take_step(StepSpace& space, const StepInput& input, const StepLimits& limits,
                     Newton::Patience& patience);

} // namespace toile
