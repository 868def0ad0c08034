#pragma once

#include <vector>

#include "export/cache_layout.h"
#include "export/mesh/cache_sample.h"

namespace toile::exports {

/// A sample of meshes and their velocities.
struct MovingSample {
    View<const Vec3> positions;
    View<const Vec3> velocities;  ///< [vertices] per second; may be empty
    View<const float> attributes; ///< as CacheSample::attributes
};

/// What each of the meshes has of a sample of all.
std::vector<MovingSample> by_mesh(const MovingSample& sample, const std::vector<CacheMesh>& meshes);

/// Velocities of frames by central differences, one-sided at the first and the last. A frame is complete when
/// the next one is known, or finish() says that there is none.
class FrameVelocities {
public:
    explicit FrameVelocities(double frames_per_second) : frames_per_second_(frames_per_second) {}

    /// Takes a frame. @return whether that completes the one before
    bool advance(const SampleView& sample);
    /// Completes the last frame. @return whether one was left
    bool finish();

    /// The frame completed last, until the next call.
    MovingSample completed() const { return {before_.positions, velocities_, before_.attributes}; }

private:
    void differentiate(const CacheSample& next);

    double frames_per_second_;
    CacheSample before_, waiting_; ///< empty: none
    std::vector<Vec3> velocities_;
};

} // namespace toile::exports
