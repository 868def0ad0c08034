#pragma once

#include <array>
#include <vector>

#include "core/mesh/axis_segment.h"
#include "garment/pattern/pattern.h"

namespace toile::garment {

/// Segments of one body in one pose, by BodySegment.
using ArrangementSegments = std::array<AxisSegment, 6>;

/// Distance between panels of successive layers where sewing starts [m].
inline constexpr double kLayerDistance = 0.01;

/// Places the vertices of meshed panels where sewing starts. A panel without `place` lies flat, by its
/// placement. One with `place` is bent around its segment of the body, or lies flat beside it:
///
///   - its middle, that of the box about it, is at `angle_deg` and `height`;
///   - bent, it lies on a cylinder around the convex hull of the skin between its lower and upper end, at
///     `distance`. Arc lengths stay, so that cloth is not stretched. The cylinder grows until the panel does
///     not reach around itself, nor over those of its layer beside it;
///   - its outer side faces outwards. Its y axis points along the segment, to where the height is 1. If its
///     file places it otherwise, by a placement that is not the identity, then that one of its four axis
///     directions does which the placement turns nearest to it: sleeves are drafted lying as often as
///     upright.
///
/// Panels start kLayerDistance further outside for each layer above the lowest of the pattern, so that those
/// which lie on each other do not start in one place.
/// @param uv               [vertices] in the panels' planes [m]
/// @param panel_of_vertex  [vertices] index into Pattern::panels
/// @param body             by BodySegment; may be null if no panel has `place`
/// @return [vertices] [m]
/// @throws InvalidInput naming the panel that needs a body
std::vector<Vec3> place_panels(const Pattern& pattern, View<const Vec2> uv, View<const int> panel_of_vertex,
                               const ArrangementSegments* body);

} // namespace toile::garment
