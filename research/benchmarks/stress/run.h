#pragma once

#include <functional>

#include "research/benchmarks/stress/cases.h"

namespace toile::research::stress {

/// Limits that a case must keep.
struct Limits {
    /// [-] Energy gained, relative to the energy of the start plus that added by moving colliders. Implicit
    /// Euler only loses energy; the rest is the tolerance for unfinished minimisations.
    double energy_gain = 0.01;
    double rest_speed = 0.01;  ///< [m/s] fastest vertex of cloth at rest
    double rest_window = 0.25; ///< [s] at the end of a case, over which cloth must be at rest
    double drift = 4e-3; ///< [m] maximum displacement of a vertex in a case at rest: stacked folds tremble
};

/// Results of a case.
struct Result {
    std::string name;
    int steps = 0;
    double iterations_per_step = 0.0;
    double ms_per_step = 0.0;
    double final_speed = 0.0; ///< [m/s] fastest vertex within the rest window
    double max_strain = 0.0;  ///< [-] after the first step
    /// [-] Maximum energy after the start, over the energy of the start plus that added by moving colliders.
    double energy_ratio = 0.0;
    double end_energy = 0.0; ///< [-] energy at the end over that of the start: where cloth came to rest
    double drift = 0.0;      ///< [m] maximum displacement of a vertex from its start; only for cases at rest
    bool is_finite = true;
    bool is_at_rest = false;
    bool holds = false; ///< finite, energy bounded, at rest, and no drift if that counts
};

/// Runs one case.
/// @param after_step  called with the number of steps done; false stops the case
Result run(const Case& trial, const Limits& limits, const std::function<bool(int)>& after_step);

} // namespace toile::research::stress
