#include "collision/untangle/start_report.h"

#include <algorithm>

namespace toile {

int StartReport::count(StartPlace::Kind kind) const
{
    return int(std::count_if(places.begin(), places.end(),
                             [&](const StartPlace& place) { return place.kind == kind; }));
}

int StartReport::remaining(StartPlace::Kind kind) const
{
    return int(std::count_if(places.begin(), places.end(), [&](const StartPlace& place) {
        return place.kind == kind && !place.is_repaired;
    }));
}

int StartReport::vertices_inside() const
{
    return int(std::count_if(places.begin(), places.end(), [&](const StartPlace& place) {
        return place.kind == StartPlace::Kind::InsideBody && place.vertex[1] < 0;
    }));
}

double StartReport::deepest(StartPlace::Kind kind) const
{
    double deepest = 0.0;
    for (const StartPlace& place : places)
        if (place.kind == kind)
            deepest = std::max(deepest, place.depth);
    return deepest;
}

bool StartReport::is_clean() const
{
    return std::all_of(places.begin(), places.end(), [](const StartPlace& place) { return place.is_held; });
}

} // namespace toile
