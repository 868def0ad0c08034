#pragma once

#include <memory>
#include <vector>

#include "core/pd/minimiser/make_outer_loop.h"
#include "core/pd/step/point_masses.h"
#include "core/pd/step/step_objective.h"

namespace toile {

/// Deformable body advanced by implicit Euler: each step minimises StepObjective.
class Body : public PointMassesOnHost {
public:
    struct Settings {
        /// [m] Error allowed at the end of a step: StepError's estimate, and the next displacement of any
        /// vertex. Lowered to a tenth of the largest predicted displacement, but never below a five-hundredth
        /// of this.
        double tolerance = 1e-5;
        int max_iterations = 50; ///< outer iterations per minimisation
        int max_passes = 3;      ///< see StepPasses
        int history = 5;         ///< pairs of L-BFGS, steps of Anderson acceleration
        OuterMethod outer = OuterMethod::Lbfgs;
        NestedPcg::Settings contact_solve; ///< while contacts are active
        StepStop stop = StepStop::Error;   ///< what the tolerance bounds
    };

    Body(std::vector<Vec3> positions, std::unique_ptr<System> system, Settings settings);

    void prepare(double dt, const std::vector<unsigned char>& fixed) override { system_->prepare(dt, fixed); }
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection) override;

    View<const double> masses() const override { return system_->masses(); }
    const System& system() const { return *system_; }

private:
    StepStart start_of(double dt) const;
    double tolerance() const;
    OuterLoop::Outcome no_worse_than_standing(double dt, StepObjective& objective,
                                              OuterLoop::Settings settings, const OuterLoop::Outcome& found);
    void minimise(double dt, ActiveSetEnergy* active, StepReport& report);

    std::unique_ptr<System> system_;
    Settings settings_;
    std::unique_ptr<OuterLoop> outer_;
    std::vector<Vec3> prediction_, standing_, gradient_;
};

} // namespace toile
