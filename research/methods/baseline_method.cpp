#include "research/methods/baseline_method.h"

#include "core/base/stages.h"

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
        project(dt, fixed, active, *projection);
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

/// Applies the limit, and contact between its sweeps.
void BaselineMethod::project(double dt, View<const unsigned char> fixed, const ActiveSetEnergy* active,
                             StepProjection& projection)
{
    const StageScope stage("pd/limits");
    std::function<bool()> clear_contacts;
    if (active)
        clear_contacts = [&] { return active->sweep_once(x_t1_); };
    PointMassesOnHost::project(projection, dt, cloth_.masses, fixed, clear_contacts);
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
