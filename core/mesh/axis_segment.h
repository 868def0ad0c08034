#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile {

/// Straight part of a body: an axis, and the skin around it.
struct AxisSegment {
    Vec3 start = Vec3::Zero();  ///< [m] where the height along it is 0
    Vec3 end = Vec3::UnitY();   ///< [m] where it is 1; not the start
    Vec3 front = Vec3::UnitZ(); ///< that faces angle 0, unit and normal to the axis
    std::vector<Vec3> skin;     ///< [m] vertices of the skin around it, and beyond its ends where it goes on

    double length() const { return (end - start).norm(); }
    Vec3 axis() const { return (end - start).normalized(); }
    /// Direction that faces 90 degrees: to the left of a body that stands.
    Vec3 left() const { return axis().cross(front); }
};

} // namespace toile
