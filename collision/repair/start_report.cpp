#include "collision/repair/start_report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace toile::collision {

void StartReport::append(const StartReport& other)
{
    defects.insert(defects.end(), other.defects.begin(), other.defects.end());
    changes.insert(changes.end(), other.changes.begin(), other.changes.end());
    too_near.insert(too_near.end(), other.too_near.begin(), other.too_near.end());
    was_repaired = was_repaired || other.was_repaired;
    passes = std::max(passes, other.passes);
    max_strain = std::max(max_strain, other.max_strain);
    max_move = std::max(max_move, other.max_move);
    const double squares =
        edge_count * rms_strain * rms_strain + other.edge_count * other.rms_strain * other.rms_strain;
    edge_count += other.edge_count;
    rms_strain = edge_count > 0 ? std::sqrt(squares / edge_count) : 0.0;
}

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

int StartReport::vertices_too_near() const
{
    return std::accumulate(
        too_near.begin(), too_near.end(), 0,
        [](int sum, const std::vector<int>& of_cloth) { return sum + int(of_cloth.size()); });
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
