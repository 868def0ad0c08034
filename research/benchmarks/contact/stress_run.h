#pragma once

#include <functional>

#include "research/benchmarks/contact/stress_cases.h"

namespace toile::research::contact_stress {

/// [-] Limit of the energy gained, over the energy of the throw: see stress::Limits::energy_gain.
inline constexpr double kEnergyGain = 0.01;

/// Results of a case with one seed.
struct StressRun {
    unsigned seed = 0;
    int vertices = 0;
    int steps = 0;     ///< including the throw
    int crossings = 0; ///< maximum number of crossing triangle pairs after a step, by exact predicates
    int first_crossing =
        0;                 ///< step after which the first crossing existed; 0: never, or already at the start
    double contacts = 0.0; ///< active pairs, per step after the throw
    double iterations = 0.0;  ///< outer, per step after the throw
    double ms_per_step = 0.0; ///< after the throw, without factoring
    double max_strain = 0.0;  ///< [-]
    /// [-] Maximum kinetic + elastic + potential energy after the throw over that at the throw.
    double energy_ratio = 0.0;
    double end_energy = 0.0; ///< [-] at the end over that at the throw; below 0 if cloth has fallen
    bool is_finite = true;
    bool holds = false; ///< finite, nothing crossed, energy bounded
};

/// Results of a case with all its seeds: worst values, but means of contacts, iterations and times.
struct StressResult {
    StressCase trial;
    std::vector<StressRun> runs;
    StressRun worst; ///< its seed: the first that does not hold, 0 if all do
};

/// Runs a case with one seed.
/// @param scene       stress_scene() of the case and the seed
/// @param after_step  called with the number of steps done; false stops the run
StressRun run(const StressCase& trial, unsigned seed, const scenes::Scene& scene,
              const std::function<bool(int)>& after_step);

/// @param runs  at least one
StressResult summarise(const StressCase& trial, std::vector<StressRun> runs);

} // namespace toile::research::contact_stress
