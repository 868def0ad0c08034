#pragma once

#include "core/compute/types.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::preview {

/// Direction and lens of a picture; fit_camera() chooses the position.
struct CameraSettings {
    double azimuth_deg = 30.0;   ///< around Y from +Z (the front of an avatar) towards +X
    double elevation_deg = 12.0; ///< above the horizontal, below 90
    double fov_deg = 35.0;       ///< vertical opening angle
    double zoom = 1.0;           ///< > 1 comes closer; at 1 everything just fits, with a margin
};

/// A rectangle of a picture, in fractions of its width and height from the upper left corner [-].
struct Crop {
    double left = 0.0, top = 0.0, right = 1.0, bottom = 1.0;
};

/// A pinhole camera.
struct Camera {
    Vec3 origin = Vec3::Zero();    ///< [m]
    Vec3 right = Vec3::UnitX();    ///< unit
    Vec3 up = Vec3::UnitY();       ///< unit
    Vec3 forward = -Vec3::UnitZ(); ///< unit
    double tan_half_fov = 0.3;     ///< of half the vertical opening angle [-]
    double aspect = 4.0 / 3.0;     ///< width over height of the whole picture [-]
    Crop crop;                     ///< part of the picture that is taken

    /// Picture coordinates of a point of the part taken, in fractions of its size from its upper left corner.
    Vec2 picture_coordinates(double column, double row) const;

    /// Unit direction through picture coordinates in [-1, 1] x [-1, 1], y up.
    Vec3 direction(double x, double y) const;
    /// Picture coordinates of a point in front of the camera.
    Vec2 project(const Vec3& point) const;
};

/// Closest camera with these settings that sees all points, with a margin around them.
/// @param points  [m] vertices, or the corners of a box around all frames
/// @throws InvalidInput for no points or settings out of range.
Camera fit_camera(View<const Vec3> points, const CameraSettings& settings, double aspect);

/// The camera shifted across its direction and along it, so that `target` [m] is in the middle of the picture
/// at the distance along the direction that `before` has.
Camera aimed_at(Camera camera, const Vec3& target, const Vec3& before);

/// The camera turned about the vertical through `pivot` [m], from +Z towards +X.
Camera turned(Camera camera, double angle_deg, const Vec3& pivot);

/// The eight corners of a box.
std::vector<Vec3> corners(const Bounds& box);
/// Points around the upright cylinder about a box: a camera that is turned about its axis sees them alike.
std::vector<Vec3> cylinder_around(const Bounds& box);

} // namespace toile::preview
