#pragma once

#include <array>
#include <optional>
#include <vector>

#include "garment/pattern/mesh/outline_points.h"
#include "garment/pattern/mesh/panel_fill.h"
#include "garment/pattern/mesh/pattern_mesh.h"

namespace toile::garment {

/// End of a line on its panel's outline.
struct LineEnd {
    int edge = 0;
    double fraction = 0.0; ///< [-] of the edge's arc length
};

/// Ends of a line that lie on the outline.
using LineEnds = std::array<std::optional<LineEnd>, 2>;

/// Finds where lines meet the outlines of their panels.
/// @return [lines]
/// @throws InvalidInput for a line of a panel that does not exist or with fewer than two points
///         or a side that is longer than the outline
std::vector<LineEnds> place_lines(const Pattern& pattern, const PatternCurves& curves,
                                  const std::vector<InnerLine>& lines);

/// Fractions of edges at which lines end, and where closures and attachments have points. [panels][edges],
/// ascending
std::vector<std::vector<std::vector<double>>> marks_of(const Pattern& pattern, const PatternCurves& curves,
                                                       const std::vector<InnerLine>& lines,
                                                       const std::vector<LineEnds>& ends);

/// Frame of a panel: its outline and its lines, divided, and points of closures and attachments inside. Those
/// nearer than half the target to an edge or point are left out.
struct LinedFrame {
    PanelFrame frame;
    std::vector<std::vector<int>>
        lines; ///< [lines of the pattern] points of the frame; empty in other panels
};

/// @param polygon    outline of the panel at its points, along the loop [m]
/// @param fractions  [edges] of its points
/// @param divided    [lines] points along a line that is divided already [m]; empty: by the target
/// @param target     [m] length of edges
/// @throws InvalidInput for a line that crosses the outline, another line or itself, or lies outside
LinedFrame lined_frame(const Pattern& pattern, int panel, const std::vector<Vec2>& polygon,
                       const std::vector<std::vector<double>>& fractions, const std::vector<InnerLine>& lines,
                       const std::vector<LineEnds>& ends, const std::vector<std::vector<Vec2>>& divided,
                       double target);

} // namespace toile::garment
