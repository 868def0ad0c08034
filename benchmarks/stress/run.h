#pragma once

#include <functional>

#include "benchmarks/stress/cases.h"

namespace toile::stress {

/// What a case must keep to.
struct Limits {
    /// [-] Energy gained, relative to what the start holds and moving obstacles may bring in: implicit Euler
    /// only loses energy, so this is what an unfinished minimisation may leave.
    double energy_gain = 0.01;
    double rest_speed = 0.01;  ///< [m/s] fastest vertex of cloth at rest
    double rest_window = 0.25; ///< [s] at the end of a case, over which cloth must be at rest
    double drift = 4e-3;       ///< [m] farthest move of a vertex in a case at rest: folds on folds tremble
};

/// What came out of a case.
struct Result {
    std::string name;
    int steps = 0;
    double iterations_per_step = 0.0;
    double ms_per_step = 0.0;
    double final_speed = 0.0; ///< [m/s] fastest vertex within the rest window
    double max_strain = 0.0;  ///< [-] after the first step
    /// [-] Largest energy after the start, over what the start holds and moving obstacles may bring in.
    double energy_ratio = 0.0;
    double end_energy = 0.0; ///< [-] energy at the end over the start's: where cloth came to rest
    double drift = 0.0;      ///< [m] farthest that a vertex ever was from its start; only for cases at rest
    bool is_finite = true;
    bool rests = false;
    bool holds = false; ///< finite, energy bounded, at rest, and no drift where that counts
};

/// Runs one case.
/// @param after_step  called with the number of steps done; false breaks the case off
Result run(const Case& trial, const Limits& limits, const std::function<bool(int)>& after_step);

} // namespace toile::stress
