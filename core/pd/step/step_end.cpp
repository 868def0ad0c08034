#include "core/pd/step/step_end.h"

#include "core/compute/parallel.h"

namespace toile {

void StepEnd::satisfy(ActiveSetEnergy* active, StepProjection* projection)
{
    bool goes_on = true;
    for (int pass = 0; goes_on && pass < kPasses; ++pass) {
        if (active)
            active->clear(x_, v_);
        if (projection)
            project(*projection, active);
        goes_on = active && active->keep_apart(x_, v_);
    }
}

void StepEnd::project(StepProjection& projection, const ActiveSetEnergy* active)
{
    const StageScope stage("pd/limits");
    inverse_masses_.resize(x_.size());
    for (int i = 0; i < x_.size(); ++i)
        inverse_masses_[i] = fixed_[i] ? 0.0 : 1.0 / masses_[i];
    unprojected_.assign(x_.begin(), x_.end());
    std::function<bool()> clear_contacts;
    if (active)
        clear_contacts = [&] { return active->sweep_once(x_); };
    projection.project(x_, inverse_masses_, clear_contacts);
    parallel_for(kCpu, "pd/finish", x_.size(), [&](int i) { v_[i] += (x_[i] - unprojected_[i]) / dt_; });
}

} // namespace toile
