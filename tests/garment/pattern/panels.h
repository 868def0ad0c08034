#pragma once

#include "garment/pattern/pattern.h"

namespace toile::test {

/// Panel with straight edges through these corners; edge i starts at corner i.
inline garment::Panel polygon(const std::string& name, const std::vector<Vec2>& corners)
{
    garment::Panel panel;
    panel.name = name;
    panel.corners = corners;
    for (int i = 0; i < int(corners.size()); ++i)
        panel.edges.push_back({i, (i + 1) % int(corners.size()), garment::Bezier{}, {}});
    return panel;
}

/// Rectangle with its lower left corner at the origin: edges bottom, right, top, left.
inline garment::Panel rectangle(const std::string& name, double width, double height)
{
    return polygon(name, {{0.0, 0.0}, {width, 0.0}, {width, height}, {0.0, height}});
}

/// Whole edge, run forward or backward.
inline garment::EdgePart forward(int panel, int edge) { return {panel, edge, 0.0, 1.0}; }
inline garment::EdgePart backward(int panel, int edge) { return {panel, edge, 1.0, 0.0}; }

inline garment::Seam seam(const garment::EdgePart& a, const garment::EdgePart& b)
{
    garment::Seam made;
    made.a = {a};
    made.b = {b};
    made.name = "seam";
    return made;
}

} // namespace toile::test
