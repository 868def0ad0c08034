#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "core/compute/types.h"

namespace toile::exports {

/// Gives each frame the velocities of its vertices: central differences, so that a frame is delivered when
/// the next one arrives; the first and the last are one-sided. A single frame has none: zero.
class FrameVelocities {
public:
    /// Takes positions, and velocities per second [vertices].
    using Deliver = std::function<void(View<const Vec3> positions, View<const Vec3> velocities)>;

    FrameVelocities(double samples_per_second, Deliver deliver)
        : samples_per_second_(samples_per_second), deliver_(std::move(deliver))
    {
    }

    void add(View<const Vec3> positions);

    /// Delivers the frame that waits.
    void finish();

private:
    void deliver_waiting(const std::vector<Vec3>& next);

    double samples_per_second_;
    Deliver deliver_;
    std::vector<Vec3> before_, waiting_; ///< frames; empty: none
};

} // namespace toile::exports
