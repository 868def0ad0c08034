#pragma once

#include <array>
#include <optional>
#include <vector>

#include "garment/pattern/edge_curve.h"

namespace toile::garment {

/// [panels][edges]
using PatternCurves = std::vector<std::vector<EdgeCurve>>;

/// Checks that every panel is one closed, simple loop of edges, and returns their curves.
/// @throws InvalidInput naming source, panel and edges
PatternCurves outline_curves(const Pattern& pattern);

/// Two sides of a closed polygon that have a point in common beyond the corner between them; side i starts in
/// corner i. None if the polygon is simple. Exact.
/// @param corners  [3 or more] around the polygon
std::optional<std::array<int, 2>> find_crossing(const std::vector<Vec2>& corners);

/// The same for edges between points: two that have a point in common beyond an end that they share.
/// @param edges  pairs of points
/// @return two of `edges`
std::optional<std::array<int, 2>> find_crossing(const std::vector<Vec2>& points,
                                                const std::vector<std::array<int, 2>>& edges);

} // namespace toile::garment
