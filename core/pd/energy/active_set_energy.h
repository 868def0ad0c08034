#pragma once

#include "core/pd/energy/frozen_hessian.h"
#include "core/pd/energy/step_field.h"

namespace toile {

class CudaSpace;
class DeviceActiveSet;

/// How far a minimisation is from its minimum.
enum class MinimiserProgress {
    kFar,
    kNear,
    kConverged,
    kSettled ///< has converged time and again, while the energy changed in between
};

/// State of a body at the start of a step, for an energy with an active set.
struct StepStart {
    View<const Vec3> x;              ///< [vertices] positions at t0 [m]; empty if a GPU makes the step
    View<const Vec3> prediction;     ///< [vertices] q* = x + dt v + dt^2 f/m [m]; as x
    View<const double> diagonal;     ///< [vertices] of H [N/m]: reference scale of penalty stiffnesses
    View<const unsigned char> fixed; ///< [vertices] 1 if the position is prescribed
    View<const double> masses;       ///< [vertices] [kg]; unspecified for unknowns that are no vertices
    double dt = 0.0;                 ///< [s]
    View<const double> inertia = {}; ///< [vertices] of the objective [N/m]; empty: masses / dt^2

    /// True if frozen Hessians are to be true ones, for Newton's method. False: convex majorisers, for
    /// methods that take them into a fixed H.
    bool wants_true_hessian = false;

    /// Device views of the first five, valid until the end of the step; empty if no GPU makes it.
    struct Device {
        View<const Vec3> x, prediction;
        View<const double> diagonal;
        View<const unsigned char> fixed;
        View<const double> masses;
    } device = {};
};

/// Convex energy whose active terms change, contact above all. It stays out of H. While it is active the
/// solver inverts H + dH by preconditioned CG instead of H directly.
class ActiveSetEnergy : public FrozenHessian {
public:
    /// Finds the candidates of this step.
    virtual void begin_step(const StepStart& start) = 0;

    /// False if there are no candidates: nothing becomes active before the next search for candidates.
    virtual bool may_be_active() const { return true; }

    /// Moves a start guess out of the candidates' forbidden half-spaces, as contact alone would. False only
    /// if nothing has moved; true does not guarantee movement.
    virtual bool make_feasible(StepField x) const = 0;

    /// Makes a single sweep of make_feasible(), for callers that alternate with sweeps over other
    /// constraints.
    virtual bool sweep_once(StepField x) const = 0;

    /// Adds the gradient [N] and returns the energy [J] at x. Same bits for every thread count.
    virtual double add_gradient(View<const Vec3> x, View<Vec3> gradient) const = 0;

    /// Freezes the terms active at x into dH. False if there are none: the solver then skips PCG.
    virtual bool activate(View<const Vec3> x) = 0;

    /// GPU counterpart with the current terms, valid until the next search for candidates: begin_step(),
    /// revise(), clear(). Null if there is none. In a minimisation with it, the device does the work of
    /// activate() and add_gradient().
    virtual DeviceActiveSet* on_device([[maybe_unused]] const CudaSpace& space) { return nullptr; }

    /// Marks the vertices of terms that press at x: touches[i] becomes 1.
    /// @param touches  [vertices] on the machine that makes the step
    virtual void mark_touching([[maybe_unused]] StepField x, [[maybe_unused]] View<unsigned char> touches) {}

    /// Called after every minimisation. Refreshes lagged quantities (friction limits) if x is converged, and
    /// searches again if x left the neighbourhood of the candidates. Moves x [vertices] back if it violates
    /// the invariants of keep_apart(); where nothing is near, only once x is converged. True if the energy
    /// changed enough to minimise again; once x has settled, by more than other candidates.
    /// @param progress  converged, settled: the minimisation was not cut short, and forces at x exceed its
    ///                  residual
    virtual bool revise(StepField x, MinimiserProgress progress) = 0;

    /// Removes what the minimisation has left inside the forbidden half-spaces.
    /// @param x, v  [vertices] its positions and velocities, modified
    virtual void clear(StepField x, StepField v) = 0;

    /// Replaces clear() for a method that ignores this energy. Takes the positions x and velocities v
    /// [vertices] found without contact, and changes them as rigid contact would.
    virtual void resolve(StepField x, StepField v) { clear(x, v); }

    /// True if the energy and keep_apart() hold all that this holds: the minimiser's result is then only
    /// shortened. False if clear() is to correct it before.
    virtual bool is_complete() const { return false; }

    /// Final correction of positions x and velocities v [vertices], after all others. Moves back whatever
    /// would break an invariant, such as cloth that would have passed through cloth. True if it moved far:
    /// the other corrections may then continue from there, followed by another call.
    virtual bool keep_apart(StepField x, StepField v) = 0;

    /// Stores the state that the next step builds on. x [vertices] are the final positions.
    virtual void end_step(StepField x) = 0;

    /// Goes back to before begin_step(). In place of clear(), keep_apart() and end_step().
    virtual void abandon_step() {}
};

} // namespace toile
