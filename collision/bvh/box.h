#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include "core/compute/types.h"

namespace toile::collision {

/// Axis-aligned box in single precision, empty at first. Coordinates are relative to a centre chosen by the
/// owner and are rounded outwards.
struct Box {
    std::array<float, 3> lower{kFar, kFar, kFar};    ///< [m]
    std::array<float, 3> upper{-kFar, -kFar, -kFar}; ///< [m]

    static constexpr float kFar = std::numeric_limits<float>::max();

    TOILE_HD void add(const Box& other)
    {
        for (int k = 0; k < 3; ++k) {
            lower[k] = std::min(lower[k], other.lower[k]);
            upper[k] = std::max(upper[k], other.upper[k]);
        }
    }
    TOILE_HD bool overlaps(const Box& other) const
    {
        // Bitwise: six comparisons cost less than one mispredicted branch.
        return bool(int(lower[0] <= other.upper[0]) & int(other.lower[0] <= upper[0]) &
                    int(lower[1] <= other.upper[1]) & int(other.lower[1] <= upper[1]) &
                    int(lower[2] <= other.upper[2]) & int(other.lower[2] <= upper[2]));
    }
    /// Sum of the extents [m]: the measure that decides which of two boxes a descent opens.
    TOILE_HD float size() const
    {
        return (upper[0] - lower[0]) + (upper[1] - lower[1]) + (upper[2] - lower[2]);
    }
    /// Half the surface [m^2] of the box with every face moved inwards by `shrink` [m]; 0 if nothing is left.
    TOILE_HD float half_area(float shrink = 0.0f) const
    {
        std::array<float, 3> extent{};
        for (int k = 0; k < 3; ++k)
            extent[k] = std::max(0.0f, (upper[k] - lower[k]) - 2.0f * shrink);
        return extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0];
    }
};

} // namespace toile::collision
