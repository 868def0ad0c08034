#pragma once

#include <functional>

#include "research/benchmarks/stress/solid_cases.h"

namespace toile::research::stress {

/// Limits that a case of tetrahedra must keep.
struct SolidLimits {
    /// [-] Distance from the minimum of a step that claims convergence, over its tolerance.
    double distance = 1.0;
    double energy_gain = 0.01; ///< [-] see SolidResult
};

/// Results of a case.
struct SolidResult {
    std::string name;
    int steps = 0;
    int unfinished = 0; ///< steps that end at the iteration limit, and say so
    int wrong = 0;      ///< steps that claim convergence beyond SolidLimits::distance
    double iterations_per_step = 0.0;
    double ms_per_step = 0.0;
    double newton = 0.0;   ///< [-] largest exact Newton step where convergence is claimed, over its tolerance
    double distance = 0.0; ///< [-] likewise, from the minimum

    /// [-] Largest energy over that of the start, relative to the elastic energy of the start and the weight
    /// times the bar's diagonal.
    double energy_gain = 0.0;
    int inverted = 0; ///< tetrahedra inside out at the end
    bool is_finite = true;
    bool holds = false; ///< finite, no wrong claim, energy bounded
};

/// Runs one case, with the settings of a scene's soft bodies.
/// @param after_step  called with the number of steps done; false stops the case
SolidResult run(const SolidCase& trial, const SolidLimits& limits,
                const std::function<bool(int)>& after_step);

} // namespace toile::research::stress
