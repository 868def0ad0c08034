#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile {

/// Splits a polygon into triangles, by cutting ears in its mean plane [Meisters 1975]. A convex quadrilateral
/// is split between its first and third corner; of other polygons the ears with good angles and short
/// diagonals go first. Corners may be concave or lie on straight sides.
/// @param corners  [3 or more] around the polygon [m]; the sides may not cross
/// @return [corners - 2] numbers of corners, in the polygon's orientation
std::vector<Triangle> triangulate_polygon(View<const Vec3> corners);

/// Convex hull, counter-clockwise.        [Andrew 1979]
/// @return corners; fewer than three for points on a line
std::vector<Vec2> convex_hull(std::vector<Vec2> points);

} // namespace toile
