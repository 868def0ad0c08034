#include "research/methods/baseline_method.h"

#include "core/pd/step/step_end.h"

namespace toile::research {

StepReport BaselineMethod::step(double dt, View<const Vec3> acceleration,
                                const std::vector<unsigned char>& fixed, View<const Vec3> targets,
                                ActiveSetEnergy* active, StepProjection* projection)
{
    if (active)
        begin_contact(dt, acceleration, fixed, targets, *active);
    StepReport report = advance(dt, acceleration, fixed, targets);
    if (report.status == StepReport::Status::NonFinite)
        return report;

    if (projection)
        projection->observe(x_t1_);
    if (active)
        active->resolve(x_t1_, v_);
    if (projection)
        StepEnd(x_t1_, v_, cloth_.masses, fixed, dt).project(*projection, active);
    if (active) {
        // Let contact take precedence where limit and contact contradict each other.
        if (projection)
            active->make_feasible(x_t1_);
        active->keep_apart(x_t1_, v_);
        active->end_step(x_t1_);
    }
    x_.swap(x_t1_);
    return report;
}

/// Begins contact with inertia as the diagonal that scales it, since these methods have no H.
void BaselineMethod::begin_contact(double dt, View<const Vec3> acceleration, View<const unsigned char> fixed,
                                   View<const Vec3> targets, ActiveSetEnergy& active)
{
    reach_.resize(x_.size());
    predict(dt, acceleration, fixed, targets, reach_);
    diagonal_ = cloth_.masses;
    for (double& inertia : diagonal_)
        inertia /= dt * dt;
    active.begin_step({x_, reach_, diagonal_, fixed, cloth_.masses, dt});
}

} // namespace toile::research
