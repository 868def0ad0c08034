#pragma once

#include <functional>

#include "core/pd/energy/active_set_energy.h"
#include "core/pd/newton/newton.h"
#include "core/pd/step/step_projection.h"
#include "core/pd/step/step_report.h"

namespace toile {

/// Inputs of a step.
struct StepInput {
    double dt = 0.0;                         ///< [s]
    View<const Vec3> acceleration;           ///< [vertices] see PointMasses::step
    const std::vector<unsigned char>& fixed; ///< [vertices] 1 if `targets` prescribes the end position
    View<const Vec3> targets;                ///< [vertices] read where fixed [m]
    ActiveSetEnergy* active = nullptr;       ///< contact; may be null
    StepProjection* projection = nullptr;    ///< may be null
    double max_error = kAnyStepError;        ///< [m] see PointMasses::refuse_steps_beyond
};

/// Parts of a step, on the machine that holds the fields of the body: the CPU (Body) or a GPU (DeviceBody).
/// take_step() calls them in order.
class StepSpace {
public:
    /// Prepares H, and predicts the end of the step, which is the start guess.
    /// @throws InvalidInput if the contact or the projection cannot be computed here
    virtual void begin(const StepInput& input) = 0;

    /// Begins the motion of vertices anew that will touch something: called when contact is known.
    virtual void restart_touching(const StepInput& input) = 0;

    virtual StepStart start() const = 0;    ///< after begin()
    virtual StepField end_positions() = 0;  ///< guess, then minimiser, then final positions [m]
    virtual StepField end_velocities() = 0; ///< at the end of the step, from finish() on [m/s]

    /// Minimises the objective of the step from the end positions, which move to the result. The first
    /// result of a step is no worse than no motion: W(x_t1) <= W(x_t0) + 1/2 |v + dt a|^2_M, however early
    /// the minimisation stopped. Stiff cloth then gains no energy from a bad start guess, and cloth at rest
    /// stays at rest.
    virtual OuterLoop::Outcome minimise(ActiveSetEnergy* active, int max_iterations, bool is_first) = 0;

    /// Minimises by Newton's method, with contact looked for between its steps. Starts from the end
    /// positions or, if the objective is lower there, from no motion.
    /// @param is_calm  nothing touches
    virtual OuterLoop::Outcome minimise_by_newton(const Newton::Settings& settings,
                                                  const Newton::Revise& revise, bool is_calm) = 0;

    /// Marks what touches at the end positions.
    virtual void mark_touching(ActiveSetEnergy& active) = 0;

    /// RMS local error of the time integration [m]. After mark_touching(), as finish().
    virtual double local_error() = 0;

    /// Goes back to before begin().
    virtual void abandon() = 0;

    /// Computes the velocities of the minimiser, and shows it to all that observe it.
    virtual void finish(StepProjection* projection) = 0;

    /// Moves the end positions onto the constraint. The displacement becomes velocity, like that of any
    /// force.
    /// @param clear_contacts  see StepProjection::project
    virtual void project(StepProjection& projection, const std::function<bool()>& clear_contacts) = 0;

    /// Makes the end the next start, and completes the report.
    virtual void end(StepProjection* projection, StepReport& report) = 0;

protected:
    StepSpace() = default;
    StepSpace(const StepSpace&) = default;
    StepSpace& operator=(const StepSpace&) = default;
    ~StepSpace() = default;
};

} // namespace toile
