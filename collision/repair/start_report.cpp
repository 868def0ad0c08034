#include "collision/repair/start_report.h"

#include <algorithm>

namespace toile::collision {

int StartReport::count(StartDefect::Kind kind) const
{
    return int(std::count_if(defects.begin(), defects.end(),
                             [&](const StartDefect& defect) { return defect.kind == kind; }));
}

int StartReport::remaining(StartDefect::Kind kind) const
{
    return int(std::count_if(defects.begin(), defects.end(), [&](const StartDefect& defect) {
        return defect.kind == kind && !defect.is_repaired;
    }));
}

int StartReport::vertices_inside() const
{
    return int(std::count_if(defects.begin(), defects.end(), [&](const StartDefect& defect) {
        return defect.kind == StartDefect::Kind::InsideBody && defect.vertex[1] < 0;
    }));
}

double StartReport::deepest(StartDefect::Kind kind) const
{
    double deepest = 0.0;
    for (const StartDefect& defect : defects)
        if (defect.kind == kind)
            deepest = std::max(deepest, defect.depth);
    return deepest;
}

bool StartReport::is_clean() const
{
    return std::all_of(defects.begin(), defects.end(),
                       [](const StartDefect& defect) { return defect.is_fixed; });
}

} // namespace toile::collision
