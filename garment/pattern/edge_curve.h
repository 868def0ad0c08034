#pragma once

#include "garment/pattern/pattern.h"

namespace toile::garment {

bool is_straight(const PanelEdge& edge);

/// Edge of a panel, or a line inside of it, as a curve over its arc length.
class EdgeCurve {
public:
    /// @throws InvalidInput for an arc whose radius is too small for its ends.
    EdgeCurve(const Panel& panel, int edge);

    /// [m] to 1e-6 of itself
    double length() const { return lengths_.back(); }

    /// Point at a fraction of the arc length from the start; exact at 0 and 1. [m] in the panel's plane
    Vec2 at(double fraction) const;

    /// Fractions of the samples between the ends: of a line, its corners. [-]
    std::vector<double> corner_fractions() const;

private:
    void measure();

    std::vector<Vec2> points_;    ///< [samples] along the curve
    std::vector<double> lengths_; ///< [samples] from the start [m]
};

/// Whether a part lies on a line inside of its panel.
inline bool is_on_line(const Pattern& pattern, const EdgePart& part)
{
    return line_of(pattern.panels[size_t(part.panel)], part.edge) != nullptr;
}

/// Signed area of a panel [m^2]: positive if its loop runs counter-clockwise in its own plane.
double signed_area(const Panel& panel);

/// Normal of the panel's loop where it is placed, which points away from the body. World [-]
Vec3 outward(const Panel& panel);

} // namespace toile::garment
