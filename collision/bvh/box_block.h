#pragma once

#include <array>

#include "collision/bvh/box.h"
#include "core/compute/lanes.h"

namespace toile::collision {

/// Eight boxes stored coordinate by coordinate. Unused lanes hold the empty box, which overlaps nothing.
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
    /// Box around all lanes.
    Box bounds() const
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

} // namespace toile::collision
