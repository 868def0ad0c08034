#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::exports {

/// Velocities of frames by central differences, one-sided at the first and the last. A frame is complete when
/// the next one is known, or finish() says that there is none.
class FrameVelocities {
public:
    explicit FrameVelocities(double frames_per_second) : frames_per_second_(frames_per_second) {}

    /// Takes a frame. @return whether that completes the one before
    bool advance(View<const Vec3> positions);
    /// Completes the last frame. @return whether one was left
    bool finish();

    /// Of the frame completed last; velocities are per second.
    const std::vector<Vec3>& positions() const { return before_; }
    const std::vector<Vec3>& velocities() const { return velocities_; }

private:
    void differentiate(const std::vector<Vec3>& next);

    double frames_per_second_;
    std::vector<Vec3> before_, waiting_, velocities_; ///< empty: none
};

} // namespace toile::exports
