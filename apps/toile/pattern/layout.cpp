#include "apps/toile/pattern/layout.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::app {
namespace {

/// Preferred width over height of the sheet.
constexpr double kAspect = 1.5;

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

/// Upper left corners of cells, and the sheet about them.
struct Packing {
    std::vector<Vec2> corners;
    Vec2 size = Vec2::Zero();

    /// Area of the sheet, increased by a shape far from the preferred one.
    double cost() const
    {
        return size.prod() * (1.0 + 0.5 * std::abs(std::log(size.x() / size.y() / kAspect)));
    }
};

/// @param order  in which the cells are placed
Packing pack(const std::vector<Vec2>& cells, const std::vector<size_t>& order, double width, double top)
{
    Packing packing{std::vector<Vec2>(cells.size())};
    Skyline skyline(width, top);
    for (const size_t cell : order) {
        packing.corners[cell] = skyline.place(cells[cell]);
        packing.size = packing.size.cwiseMax(packing.corners[cell] + cells[cell]);
    }
    return packing;
}

/// The best of sheets whose width grows from that of the widest cell.
Packing best_packing(const std::vector<Vec2>& cells, double top)
{
    std::vector<size_t> order(cells.size());
    std::iota(order.begin(), order.end(), size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return cells[a].y() > cells[b].y(); });
    double area = 0.0;
    double widest = 0.0;
    for (const Vec2& cell : cells) {
        area += cell.prod();
        widest = std::max(widest, cell.x());
    }
    constexpr int kTrials = 32;
    Packing best = pack(cells, order, widest, top);
    for (int i = 1; i <= kTrials; ++i) {
        const double width = widest + 2.0 * std::sqrt(area) * i / kTrials;
        if (Packing trial = pack(cells, order, width, top); trial.cost() < best.cost())
            best = std::move(trial);
    }
    return best;
}

} // namespace

Layout lay_out(const std::vector<PanelFacts>& panels, double margin, double header)
{
    std::vector<Vec2> cells; // [panels] with margins [mm]
    cells.reserve(panels.size());
    for (const PanelFacts& panel : panels)
        cells.emplace_back(1000.0 * panel.box.sizes() + Vec2::Constant(2.0 * margin));
    const Packing packing = best_packing(cells, header);

    Layout layout{{}, packing.size};
    for (size_t i = 0; i < panels.size(); ++i) {
        const Vec2 upper_left(panels[i].box.min().x(), -panels[i].box.max().y());
        layout.origins.emplace_back(packing.corners[i] + Vec2::Constant(margin) - 1000.0 * upper_left);
    }
    return layout;
}

} // namespace toile::app
