#pragma once

#include <memory>
#include <vector>

#include "core/pd/make_outer_loop.h"
#include "core/pd/step_report.h"
#include "core/pd/system.h"

namespace toile {

/// A hard constraint applied after the minimisation of a step, outside H: limits that would need weights far
/// above the rest of H (strain limits) stall every method that inverts a fixed H.
class StepProjection {
public:
    virtual ~StepProjection() = default;

    /// Looks at the minimiser of the step before anything moves it.
    virtual void observe(View<const Vec3> x) = 0;

    /// Moves x [vertices] onto the constraint, vertices with weight 0 not at all.
    /// @param inverse_masses  [vertices] [1/kg], 0 for fixed vertices
    /// @param active          contact to respect while projecting; may be null
    virtual void project(View<Vec3> x, View<const double> inverse_masses, const ActiveSetEnergy* active) = 0;
};

/// A deformable body advanced by implicit Euler: each step minimises StepObjective.
class Body {
public:
    struct Settings {
        /// [m] Error that a step may end with: what StepError estimates, and the next move of any vertex.
        /// Lowered to a tenth of the farthest predicted move, but never below a hundredth of this.
        double tolerance = 1e-5;
        int max_iterations = 50; ///< outer iterations per minimisation
        int max_rounds = 3;      ///< minimisations per step, when contact asks for another
        int history = 5;         ///< pairs of L-BFGS, moves of Anderson acceleration
        OuterMethod outer = OuterMethod::Lbfgs;
        Pcg::Settings linear; ///< inner PCG while contacts are active
    };

    Body(std::vector<Vec3> positions, std::unique_ptr<System> system, Settings settings);

    /// Advances by dt [s].
    /// @param acceleration  [vertices] external acceleration of this step [m/s^2]
    /// @param fixed         [vertices] 1 where `targets` prescribes the position at the end of the step
    /// @param targets       [vertices] read where fixed [m]
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection);

    View<const Vec3> positions() const { return x_; }
    View<const Vec3> velocities() const { return v_; }
    void set_positions(View<const Vec3> x) { x_.assign(x.begin(), x.end()); }
    void set_velocities(View<const Vec3> v) { v_.assign(v.begin(), v.end()); }
    const System& system() const { return *system_; }

private:
    StepStart start_of(double dt) const;
    void predict(double dt, View<const Vec3> acceleration, View<const Vec3> targets);
    void project(double dt, StepProjection& projection, const ActiveSetEnergy* active);
    double tolerance() const;
    OuterLoop::Outcome no_worse_than_standing(double dt, StepObjective& objective,
                                              OuterLoop::Settings settings, const OuterLoop::Outcome& found);
    void minimise(double dt, ActiveSetEnergy* active, StepReport& report);

    std::vector<Vec3> x_, v_;
    std::unique_ptr<System> system_;
    Settings settings_;
    std::unique_ptr<OuterLoop> outer_;
    std::vector<Vec3> prediction_, x_t1_, standing_, gradient_, unprojected_;
    std::vector<double> inverse_masses_;
};

} // namespace toile
