#pragma once

#include <vector>

#include "apps/toile/pattern/report.h"

namespace toile::app {

/// Panels side by side on a sheet, turned as in their file. Millimetres, x right, y down.
struct Layout {
    std::vector<Vec2> origins; ///< [panels] of each panel's plane on the sheet
    Vec2 size;                 ///< of the sheet

    /// Point of a panel's plane [m] on the sheet [mm].
    Vec2 on_sheet(int panel, const Vec2& point) const
    {
        return origins[size_t(panel)] + 1000.0 * Vec2(point.x(), -point.y());
    }
};

/// Panels from the highest to the lowest, each as far up as it fits, on a sheet somewhat wider than high.
/// @param margin  [mm] about every panel, for text
/// @param header  [mm] of room above them
Layout lay_out(const std::vector<PanelFacts>& panels, double margin, double header);

} // namespace toile::app
