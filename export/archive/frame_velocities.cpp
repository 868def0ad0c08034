#include "export/archive/frame_velocities.h"

#include <utility>

namespace toile::exports {

bool FrameVelocities::advance(View<const Vec3> positions)
{
    std::vector<Vec3> frame(positions.begin(), positions.end());
    const bool completes = !waiting_.empty();
    if (completes)
        differentiate(frame);
    before_ = std::exchange(waiting_, std::move(frame));
    return completes;
}

bool FrameVelocities::finish()
{
    if (waiting_.empty())
        return false;
    differentiate(waiting_);
    before_ = std::exchange(waiting_, {});
    return true;
}

/// Velocities of the frame that waits. @param next  the frame after it; itself if there is none
void FrameVelocities::differentiate(const std::vector<Vec3>& next)
{
    const std::vector<Vec3>& before = before_.empty() ? waiting_ : before_;
    const int steps = int(&next != &waiting_) + int(&before != &waiting_);
    const double per_second = steps > 0 ? frames_per_second_ / steps : 0.0;
    velocities_.resize(waiting_.size());
    for (size_t v = 0; v < velocities_.size(); ++v)
        velocities_[v] = per_second * (next[v] - before[v]);
}

} // namespace toile::exports
