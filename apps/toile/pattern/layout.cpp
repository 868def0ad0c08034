#include "apps/toile/pattern/layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::app {
namespace {

/// Width over height of the sheet, about.
constexpr double kAspect = 1.6;

/// [mm] Panels are moved in steps of that size.
constexpr double kStep = 10.0;

/// Lower ends of what lies on a sheet, from left to right.
class Skyline {
public:
    Skyline(double width, double top) : ends_(size_t(std::ceil(width / kStep)), top) {}

    /// Upper left corner of a new cell: as high as possible, then as far left.
    Vec2 place(const Vec2& cell)
    {
        const auto columns = std::min(ends_.size(), size_t(std::ceil(cell.x() / kStep)));
        size_t best = 0;
        for (size_t first = 1; first + columns <= ends_.size(); ++first)
            if (end_below(first, columns) < end_below(best, columns))
                best = first;
        const double y = end_below(best, columns);
        std::fill_n(ends_.begin() + long(best), columns, y + cell.y());
        return {kStep * double(best), y};
    }

private:
    double end_below(size_t first, size_t columns) const
    {
        return *std::max_element(ends_.begin() + long(first), ends_.begin() + long(first + columns));
    }

    std::vector<double> ends_; ///< [columns of kStep]
};

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

    Layout layout{std::vector<Vec2>(cells.size()), Vec2::Zero()};
    Skyline skyline(std::max(widest, std::sqrt(kAspect * area)), header);
    for (const size_t panel : order) {
        const Vec2 corner = skyline.place(cells[panel]);
        const Vec2 upper_left(panels[panel].box.min().x(), -panels[panel].box.max().y());
        layout.origins[panel] = corner + Vec2::Constant(margin) - 1000.0 * upper_left;
        layout.size = layout.size.cwiseMax(corner + cells[panel]);
    }
    return layout;
}

} // namespace toile::app
