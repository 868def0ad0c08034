#include "export/sequence/frame_velocities.h"

namespace toile::exports {

void FrameVelocities::add(View<const Vec3> positions)
{
    std::vector<Vec3> frame(positions.begin(), positions.end());
    if (!waiting_.empty())
        deliver_waiting(frame);
    before_ = std::exchange(waiting_, std::move(frame));
}

/// @param next  the frame after the one that waits; itself if there is none
void FrameVelocities::deliver_waiting(const std::vector<Vec3>& next)
{
    const std::vector<Vec3>& before = before_.empty() ? waiting_ : before_;
    const int steps = int(&next != &waiting_) + int(&before != &waiting_);
    const double per_second = steps > 0 ? samples_per_second_ / steps : 0.0;
    std::vector<Vec3> velocities(waiting_.size());
    for (size_t v = 0; v < velocities.size(); ++v)
        velocities[v] = per_second * (next[v] - before[v]);
    deliver_(waiting_, velocities);
}

void FrameVelocities::finish()
{
    if (waiting_.empty())
        return;
    deliver_waiting(waiting_);
    before_ = std::exchange(waiting_, {});
}

} // namespace toile::exports
