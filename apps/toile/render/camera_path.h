#pragma once

#include <vector>

#include "apps/toile/render/viewpoint.h"

namespace toile::app {

/// One picture of a film: a frame, and how far the camera has gone around it.
struct Shot {
    int frame = 0;
    double turn_deg = 0.0; ///< from the azimuth of the settings, from +Z towards +X
};

/// Width and height of the part of a picture that is taken: the largest with square pixels that lies within
/// the size of the settings. [pixels]
struct PictureSize {
    int width = 0, height = 0;
};
PictureSize size_of_part(const scene::Render& render, const preview::Crop& crop);

/// Camera of each picture. All boxes are in view; a body that walks through the scene is followed, unless the
/// target is a point.
class CameraPath {
public:
    CameraPath() = default;

    /// @param boxes  [shots] what is to be seen [m]
    CameraPath(const scene::Render& render, const preview::Crop& crop, const CameraTarget& target,
               const std::vector<Shot>& shots, const std::vector<Bounds>& boxes, double fps);

    const preview::Camera& at(size_t shot) const { return cameras_[shot]; }

private:
    std::vector<preview::Camera> cameras_; ///< [shots]
};

} // namespace toile::app
