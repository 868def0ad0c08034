#include "garment/pattern/seam_side.h"

#include <algorithm>
#include <cmath>

namespace toile::garment {

SeamSide::SeamSide(const Pattern& pattern, const std::vector<EdgePart>& parts) : parts_(parts)
{
    double end = 0.0;
    for (const EdgePart& part : parts) {
        const Panel& panel = pattern.panels[size_t(part.panel)];
        curves_.emplace_back(panel, part.edge);
        placements_.push_back(panel.placement);
        end += std::abs(part.to - part.from) * curves_.back().length();
        ends_.push_back(end);
    }
}

Vec3 SeamSide::at(double fraction) const
{
    const double s = fraction * length();
    const size_t last = ends_.size() - 1;
    const size_t i =
        std::min<size_t>(last, size_t(std::lower_bound(ends_.begin(), ends_.end(), s) - ends_.begin()));
    const double start = i == 0 ? 0.0 : ends_[i - 1];
    const double part = ends_[i] > start ? (s - start) / (ends_[i] - start) : 0.0;
    const Vec2 point = curves_[i].at(parts_[i].from + part * (parts_[i].to - parts_[i].from));
    return placements_[i] * Vec3(point.x(), point.y(), 0.0);
}

} // namespace toile::garment
