#include "apps/toile/pattern/layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::app {
namespace {

/// Width over height of the sheet that rows are broken for.
constexpr double kAspect = 1.6;

} // namespace

Layout lay_out(const std::vector<PanelFacts>& panels, double margin, double header)
{
    std::vector<Vec2> cells; // [panels] with margins [mm]
    double area = 0.0;
    double widest = 0.0;
    for (const PanelFacts& panel : panels) {
        cells.emplace_back(1000.0 * panel.box.sizes() + Vec2::Constant(2.0 * margin));
        area += cells.back().prod();
        widest = std::max(widest, cells.back().x());
    }
    std::vector<size_t> order(cells.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return cells[a].y() > cells[b].y(); });

    Layout layout{std::vector<Vec2>(cells.size()), Vec2(0.0, header)};
    const double width = std::max(widest, std::sqrt(kAspect * area));
    Vec2 corner(0.0, header); // upper left of the next cell
    for (const size_t panel : order) {
        if (corner.x() > 0.0 && corner.x() + cells[panel].x() > width)
            corner = Vec2(0.0, layout.size.y());
        const Vec2 upper_left(panels[panel].box.min().x(), panels[panel].box.max().y());
        layout.origins[panel] =
            corner + Vec2::Constant(margin) - 1000.0 * Vec2(upper_left.x(), -upper_left.y());
        layout.size = layout.size.cwiseMax(corner + cells[panel]);
        corner.x() += cells[panel].x();
    }
    return layout;
}

} // namespace toile::app
