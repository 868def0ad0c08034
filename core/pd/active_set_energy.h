#pragma once

#include "core/pd/frozen_hessian.h"
#include "core/pd/step_field.h"

namespace toile {

class CudaSpace;
class DeviceActiveSet;

/// State of a body at the start of a step, as an energy with an active set needs it.
struct StepStart {
    View<const Vec3> x;              ///< [vertices] positions at t0; empty where a GPU makes the step [m]
    View<const Vec3> prediction;     ///< [vertices] q* = x + dt v + dt^2 f/m; as x [m]
    View<const double> diagonal;     ///< [vertices] of H [N/m]: the scale that penalty stiffnesses refer to
    View<const unsigned char> fixed; ///< [vertices] 1 where the position is prescribed
    View<const double> masses;       ///< [vertices] [kg]; of unknowns that are no vertices: unspecified
    double dt = 0.0;                 ///< [s]

    /// The first five as the device has them, until the end of the step; empty where no GPU makes it.
    struct There {
        View<const Vec3> x, prediction;
        View<const double> diagonal;
        View<const unsigned char> fixed;
        View<const double> masses;
    } there = {};
};

/// A convex energy that acts on changing places, contact above all. It stays out of H; while it is active the
/// solver inverts H + dH by preconditioned CG instead of H directly.
class ActiveSetEnergy : public FrozenHessian {
public:
    /// Finds the candidates of this step.
    virtual void begin_step(const StepStart& start) = 0;

    /// False where it has no candidates: nothing can make it act before it has looked for others.
    virtual bool may_act() const { return true; }

    /// Moves a start guess out of the candidates' forbidden half-spaces as contact without anything else
    /// would. False only where nothing has moved; true is no promise.
    virtual bool make_feasible(StepField x) const = 0;

    /// A single sweep of that, for who sweeps over other constraints in between.
    virtual bool sweep_once(StepField x) const = 0;

    /// Adds the gradient [N] and returns the energy [J] at x. Same bits for every thread count.
    virtual double add_gradient(View<const Vec3> x, View<Vec3> gradient) const = 0;

    /// Freezes the terms active at x into dH. False when none is: the solver then skips PCG.
    virtual bool activate(View<const Vec3> x) = 0;

    /// Its terms as they are now on a GPU, good until a call that looks for others: begin_step(), revise(),
    /// clear(). Null where it has no such form. The activate() and add_gradient() of a minimisation there are
    /// the device's.
    virtual DeviceActiveSet* on_device([[maybe_unused]] const CudaSpace& space) { return nullptr; }

    /// After every minimisation: refreshes lagged quantities (friction limits) where x is settled, and looks
    /// again where x left the neighbourhood that the candidates were made for. True when the energy changed
    /// enough to be minimised again.
    /// x [vertices] is moved back where it has gone too far for what must always hold (keep_apart).
    /// @param is_settled  the minimisation was not cut short: forces at x are more than what it has left
    virtual bool revise(StepField x, bool is_settled) = 0;

    /// Clears what the minimisation has left inside the forbidden half-spaces. x and v [vertices] are its
    /// positions and velocities.
    virtual void clear(StepField x, StepField v) = 0;

    /// Instead of clear(), for a method that knows nothing of this energy: takes the positions x and
    /// velocities v [vertices] that it has found without, and changes them as rigid contact would.
    virtual void resolve(StepField x, StepField v) { clear(x, v); }

    /// The last word on positions x and velocities v [vertices], after all that has moved them: brings back
    /// what would break an invariant, such as cloth that would have passed through cloth. True when that was
    /// far: what moved x may go on from there, and ask again.
    virtual bool keep_apart(StepField x, StepField v) = 0;

    /// Remembers what the next step builds on. x [vertices] are the final positions.
    virtual void end_step(StepField x) = 0;
};

} // namespace toile
