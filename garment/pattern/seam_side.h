#pragma once

#include "garment/pattern/edge_curve.h"

namespace toile::garment {

/// One side of a seam, a chain of edge parts, as a curve over its arc length.
class SeamSide {
public:
    /// @param parts  Seam::a or Seam::b of `pattern`
    SeamSide(const Pattern& pattern, const std::vector<EdgePart>& parts);

    double length() const { return ends_.back(); } ///< [m]

    /// Point at a fraction of the length, where the panels are placed. World [m]
    Vec3 at(double fraction) const;

private:
    std::vector<EdgePart> parts_;
    std::vector<EdgeCurve> curves_;             ///< [parts] whole edges
    std::vector<Eigen::Isometry3d> placements_; ///< [parts]
    std::vector<double> ends_;                  ///< [parts] length up to the end of each [m]
};

} // namespace toile::garment
