#pragma once

#include <vector>

#include "core/mesh/axis_segment.h"

namespace toile::garment {

/// Closed convex curve around a part of a segment, in the plane normal to its axis, at a distance from the
/// skin: the base of the cylinder onto which panels are bent. Coordinates are along the segment's front and
/// left, from its axis.
//
//            back
//           ______
//         /  ____  \       skin, seen from above; the curve rounds its hull
//   right |  \__/  | left
//          \______/
//            front         arc length grows from the front to the left
class GirthCurve {
public:
    /// @param low, high   heights along the axis between which the skin counts [m]
    /// @param distance    from the skin, at least [m], positive
    /// @param min_length  the distance grows until the curve is as long [m]
    GirthCurve(const AxisSegment& segment, double low, double high, double distance, double min_length);

    double length() const { return arc_.back(); } ///< [m]

    /// Arc length at which the curve crosses the ray from the axis at this angle [m], 0 to length().
    double arc_at(double angle_deg) const;

    /// Point at an arc length, of any size: the curve is closed.
    Vec2 at(double arc) const;

    /// Largest extent of the curve in a direction [m].
    double support(const Vec2& direction) const;

private:
    std::vector<Vec2> corners_; ///< counter-clockwise, around the axis; the first is repeated at the end
    std::vector<double> arc_;   ///< [corners] from the first corner [m]
};

} // namespace toile::garment
