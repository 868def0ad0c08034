#pragma once

#include <cmath>

#include "core/backend/types.h"

namespace toile {

/// The tolerance that a step is minimised to: far enough below what moves in it.
struct StepTolerance {
    /// Bounds by the farthest predicted move of a step [-]: at small steps cloth that begins to fall moves
    /// less than the tolerance, and would be left hanging in the air. Never less than kLeast of the tolerance
    /// asked for: without forces nothing moves at all.
    static constexpr double kPerMove = 0.1;
    static constexpr double kLeast = 0.002;

    /// Share of the tolerance [-] for a minimisation that begins where the cloth is. Cloth at rest takes no
    /// iteration there; larger lets stiff cloth rest before it has found its shape.
    static constexpr double kStanding = 0.1;

    double asked = 0.0; ///< [m]

    /// @param farthest  predicted move of any vertex [m]
    TOILE_HD double of_step(double farthest) const
    {
        return std::fmin(std::fmax(kPerMove * farthest, kLeast * asked), asked);
    }
};

} // namespace toile
