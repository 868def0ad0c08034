#include "export/archive/frame_velocities.h"

#include <utility>

namespace toile::exports {

std::vector<MovingSample> by_mesh(const MovingSample& sample, const std::vector<CacheMesh>& meshes)
{
    std::vector<MovingSample> parts;
    int first = 0, first_number = 0;
    for (const CacheMesh& mesh : meshes) {
        const int count = mesh.vertex_count, numbers = int(mesh.attributes.size()) * count;
        parts.push_back({sample.positions.subview(first, count), sample.velocities.subview(first, count),
                         sample.attributes.subview(first_number, numbers)});
        first += count;
        first_number += numbers;
    }
    return parts;
}

bool FrameVelocities::advance(const SampleView& sample)
{
    CacheSample frame{{sample.positions.begin(), sample.positions.end()},
                      {sample.attributes.begin(), sample.attributes.end()}};
    const bool completes = !waiting_.positions.empty();
    if (completes)
        differentiate(frame);
    before_ = std::exchange(waiting_, std::move(frame));
    return completes;
}

bool FrameVelocities::finish()
{
    if (waiting_.positions.empty())
        return false;
    differentiate(waiting_);
    before_ = std::exchange(waiting_, {});
    return true;
}

/// Velocities of the frame that waits. @param next  the frame after it; itself if there is none
void FrameVelocities::differentiate(const CacheSample& next)
{
    const CacheSample& before = before_.positions.empty() ? waiting_ : before_;
    const int steps = int(&next != &waiting_) + int(&before != &waiting_);
    const double per_second = steps > 0 ? frames_per_second_ / steps : 0.0;
    velocities_.resize(waiting_.positions.size());
    for (size_t v = 0; v < velocities_.size(); ++v)
        velocities_[v] = per_second * (next.positions[v] - before.positions[v]);
}

} // namespace toile::exports
