#pragma once

#include <array>

#include "core/compute/lanes.h"

namespace toile::research {

/// One index per lane.
using LaneIndices = std::array<int, kLanes>;

/// Gathers eight numbers of a field into lanes.
inline Lanes gather_numbers(View<const double> field, const LaneIndices& item)
{
    return Lanes([&](auto lane) { return field[item[lane]]; });
}

/// Gathers eight vectors of a field into lanes.
inline Vec3Of<Lanes> gather_vectors(View<const Vec3> field, const LaneIndices& item)
{
    Vec3Of<Lanes> result;
    for (int k = 0; k < 3; ++k)
        result(k) = Lanes([&](auto lane) { return field[item[lane]][k]; });
    return result;
}

/// Writes the first `count` of eight vectors back.
inline void scatter_vectors(const Vec3Of<Lanes>& values, const LaneIndices& item, int count, View<Vec3> field)
{
    for (int lane = 0; lane < count; ++lane)
        field[item[lane]] = Vec3(values(0)[lane], values(1)[lane], values(2)[lane]);
}

} // namespace toile::research
