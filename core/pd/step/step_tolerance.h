#pragma once

#include <cmath>

#include "core/compute/types.h"

namespace toile {

/// Tolerance of a step's minimisation, well below the displacements of the step.
struct StepTolerance {
    /// Bound relative to the largest predicted displacement of a step [-]. In small steps cloth that begins
    /// to fall moves less than the tolerance, and would hang in the air. The result is at least kMinFraction
    /// of the requested tolerance, because without forces nothing moves at all.
    static constexpr double kPerMove = 0.1;
    static constexpr double kMinFraction = 0.002;

    /// Factor on the tolerance [-] of a minimisation that starts at the current positions. Cloth at rest then
    /// takes no iteration. A larger factor lets stiff cloth stop before it has found its shape.
    static constexpr double kStanding = 0.1;

    double asked = 0.0; ///< requested tolerance [m]

    /// @param max_move  largest predicted displacement of a vertex [m]
    TOILE_HD double of_step(double max_move) const
    {
        return std::fmin(std::fmax(kPerMove * max_move, kMinFraction * asked), asked);
    }
};

} // namespace toile
