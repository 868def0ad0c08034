#pragma once

/// Axis-aligned boxes in single precision, one at a time and eight side by side.

#include <algorithm>
#include <array>
#include <limits>

#include "core/backend/lanes.h"

namespace toile {

/// Contains nothing at first. Coordinates are relative to a centre that the owner chose, rounded outwards.
struct Box {
    std::array<float, 3> lower{kFar, kFar, kFar};    ///< [m]
    std::array<float, 3> upper{-kFar, -kFar, -kFar}; ///< [m]

    static constexpr float kFar = std::numeric_limits<float>::max();

    void add(const Box& other)
    {
        for (int k = 0; k < 3; ++k) {
            lower[k] = std::min(lower[k], other.lower[k]);
            upper[k] = std::max(upper[k], other.upper[k]);
        }
    }
    bool overlaps(const Box& other) const
    {
        // Bitwise: six comparisons cost less than one mispredicted branch.
        return bool(int(lower[0] <= other.upper[0]) & int(other.lower[0] <= upper[0]) &
                    int(lower[1] <= other.upper[1]) & int(other.lower[1] <= upper[1]) &
                    int(lower[2] <= other.upper[2]) & int(other.lower[2] <= upper[2]));
    }
    /// Sum of the extents [m]: how large the box is, for choosing which of two to open.
    float size() const { return (upper[0] - lower[0]) + (upper[1] - lower[1]) + (upper[2] - lower[2]); }
    /// Half the surface [m^2] of the box with every face moved inwards by `shrink` [m]; 0 where nothing is
    /// left.
    float half_area(float shrink = 0.0f) const
    {
        std::array<float, 3> extent{};
        for (int k = 0; k < 3; ++k)
            extent[k] = std::max(0.0f, (upper[k] - lower[k]) - 2.0f * shrink);
        return extent[0] * extent[1] + extent[1] * extent[2] + extent[2] * extent[0];
    }
};

/// Eight boxes, coordinate by coordinate. Unused lanes hold the empty box, which overlaps nothing.
struct alignas(32) BoxBlock {
    static constexpr int kCount = kLanes;
    std::array<std::array<float, kCount>, 3> lower;
    std::array<std::array<float, kCount>, 3> upper;

    void set(int lane, const Box& box)
    {
        for (int k = 0; k < 3; ++k) {
            lower[k][lane] = box.lower[k];
            upper[k][lane] = box.upper[k];
        }
    }
    Box get(int lane) const
    {
        return {{lower[0][lane], lower[1][lane], lower[2][lane]},
                {upper[0][lane], upper[1][lane], upper[2][lane]}};
    }
    /// The box around all.
    Box around() const
    {
        Box all;
        for (int k = 0; k < 3; ++k) {
            all.lower[k] = hmin(load(lower[k].data()));
            all.upper[k] = hmax(load(upper[k].data()));
        }
        return all;
    }
    /// Lanes whose boxes overlap `box`.
    FloatLanes::mask_type overlaps(const Box& box) const
    {
        FloatLanes::mask_type hit(true);
        for (int k = 0; k < 3; ++k)
            hit = hit && load(lower[k].data()) <= box.upper[k] && load(upper[k].data()) >= box.lower[k];
        return hit;
    }
};

/// Calls visit(lane) for every lane that is set, in ascending order.
template <typename Visit>
void for_each_lane(FloatLanes::mask_type mask, const Visit& visit)
{
    while (any_of(mask)) {
        const int lane = find_first_set(mask);
        mask[lane] = false;
        visit(lane);
    }
}

} // namespace toile
