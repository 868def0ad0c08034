#pragma once

#include <algorithm>
#include <cstdint>

#include "core/compute/types.h"

namespace toile::collision {

/// Index of a point along the Hilbert curve through a cube of 2^21 cells a side. Points near each other on
/// the curve are near in space, and unlike on Morton's curve consecutive cells are adjacent. [Skilling 2004,
/// Programming the Hilbert curve]
struct SpaceCurve {
    static constexpr int kBits = 21; ///< per axis

    Vec3 lower = Vec3::Zero(); ///< [m] corner of the cube
    double per_meter = 0.0;    ///< cells per metre; 0: all points have index 0

    /// Curve through the smallest cube with `lower` as its lower corner that contains the box.
    TOILE_HD static SpaceCurve through(const Vec3& lower, const Vec3& upper)
    {
        const double size = (upper - lower).maxCoeff();
        return {lower, size > 0.0 ? double(1 << kBits) / size : 0.0};
    }

    TOILE_HD std::uint64_t index(const Vec3& x) const
    {
        std::uint32_t cell[3];
        for (int k = 0; k < 3; ++k)
            cell[k] = std::uint32_t(
                std::min(std::max((x[k] - lower[k]) * per_meter, 0.0), double((1 << kBits) - 1)));

        // Undo the rotations of the sub-cubes, largest first.
        for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1)
            for (std::uint32_t& axis : cell) {
                const std::uint32_t below = bit - 1;
                if ((axis & bit) != 0) {
                    cell[0] ^= below;
                } else {
                    const std::uint32_t swap = (cell[0] ^ axis) & below;
                    cell[0] ^= swap;
                    axis ^= swap;
                }
            }

        // Gray code, then interleave the axes' bits.
        cell[1] ^= cell[0];
        cell[2] ^= cell[1];
        std::uint32_t flip = 0;
        for (std::uint32_t bit = 1U << (kBits - 1); bit > 1; bit >>= 1)
            if ((cell[2] & bit) != 0)
                flip ^= bit - 1;
        std::uint64_t index = 0;
        for (int b = kBits - 1; b >= 0; --b)
            for (const std::uint32_t axis : cell)
                index = index << 1 | ((axis ^ flip) >> b & 1U);
        return index;
    }
};

} // namespace toile::collision
