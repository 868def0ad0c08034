#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/pd/minimiser/make_outer_loop.h"
#include "core/pd/newton/host_newton.h"
#include "core/pd/step/bdf2.h"
#include "core/pd/step/point_masses.h"
#include "core/pd/step/step_objective.h"
#include "core/pd/step/take_step.h"

namespace toile {

/// Deformable body advanced by BDF2 or implicit Euler: each step minimises StepObjective.
class Body : public PointMassesOnHost, private StepSpace {
public:
    struct Settings {
        /// [m] Error allowed at the end of a step: StepError's estimate, and the next displacement of any
        /// vertex. Lowered to a tenth of the largest predicted displacement, but never below a five-hundredth
        /// of this.
        double tolerance = 1e-5;
        double speed_tolerance = 0.01; ///< [m/s] of Newton's method, in place of `tolerance`
        int max_iterations = 50;       ///< outer iterations per minimisation
        int max_passes = 3;            ///< see StepPasses
        int history = 5;               ///< pairs of L-BFGS, steps of Anderson acceleration
        OuterMethod outer = OuterMethod::Lbfgs;
        NestedPcg::Settings contact_solve; ///< while contacts are active
        StepStop stop = StepStop::Error;   ///< what the tolerance bounds
        Integrator integrator = Integrator::ImplicitEuler;
        Extent extent = Extent::Surface; ///< of what is simulated: for the preconditioner of Newton's method
        /// Newton's method begins with a local and a global step while nothing touches. Needs the inverse of
        /// H, anew for every step length.
        bool begins_by_local_global = true;
    };

    Body(std::vector<Vec3> positions, std::unique_ptr<System> system, Settings settings);

    void prepare(double dt, const std::vector<unsigned char>& fixed) override;
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection) override;

    void set_positions(View<const Vec3> x) override;
    void set_velocities(View<const Vec3> v) override;
    void set_stiff_parts(const std::vector<int>& of_vertex) override;
    void begin_anew() override;

    View<const double> masses() const override { return system_->masses(); }
    const System& system() const { return *system_; }

private:
    void begin(const StepInput& input) override;
    void restart_touching(const StepInput& input) override;
    StepStart start() const override;
    StepField end_positions() override { return x_t1_; }
    StepField end_velocities() override { return v_; }
    OuterLoop::Outcome minimise(ActiveSetEnergy* active, int max_iterations, bool is_first) override;
    OuterLoop::Outcome minimise_by_newton(const Newton::Settings& settings, const Newton::Revise& revise,
                                          bool is_calm) override;
    void mark_touching(ActiveSetEnergy& active) override;
    double local_error() override;
    void abandon() override;
    void finish(StepProjection* projection) override;
    void project(StepProjection& projection, const std::function<bool()>& clear_contacts) override;
    void end(StepProjection* projection, StepReport& report) override;

    MotionView motion();
    void mark_parts();
    void forget_touching();
    void predict(const StepInput& input);
    double tolerance() const;
    OuterLoop::Outcome no_worse_than_standing(OuterLoop::Settings settings, const OuterLoop::Outcome& found);

    std::unique_ptr<System> system_;
    Settings settings_;
    std::unique_ptr<OuterLoop> outer_; ///< null: Newton's method
    std::optional<HostNewton> newton_;
    Newton::Patience patience_;
    double dt_ = 0.0;                        ///< of the current step [s]
    std::optional<StepObjective> objective_; ///< of the current step
    ActiveSetEnergy* active_ = nullptr;      ///< likewise; may be null
    std::vector<Vec3> prediction_, standing_, gradient_;

    // State of the integrator: see MotionView.
    Bdf2 scheme_;
    double previous_dt_ = 0.0; ///< [s] 0: there was no step before
    std::vector<Vec3> x_previous_, v_previous_;
    std::vector<unsigned char> restart_, touched_, touches_;
    std::vector<int> stiff_part_;
    std::vector<unsigned char> part_touched_, part_touches_;
    std::vector<unsigned char> restart_before_; ///< restart_ before the step
    std::vector<Vec3> minimiser_;               ///< [vertices] [m]
    std::vector<double> inertia_;               ///< [vertices] [N/m]
    StepErrorSum error_;                        ///< of the current step
};

} // namespace toile
