#pragma once

#include <functional>

#include "benchmarks/contact/stress_cases.h"

namespace toile::contact {

/// [-] Energy gained over that of the throw: see stress::Limits::energy_gain.
inline constexpr double kEnergyGain = 0.01;

/// A case with one seed.
struct StressRun {
    unsigned seed = 0;
    int vertices = 0;
    int steps = 0;            ///< with the one that throws
    int crossings = 0;        ///< most pairs of triangles that crossed after a step, by exact predicates
    int first_crossing = 0;   ///< step after which any crossed; 0: never, or already at the start
    double contacts = 0.0;    ///< pairs that push, per step after the throw
    double iterations = 0.0;  ///< outer, per step after the throw
    double ms_per_step = 0.0; ///< after the throw, without factoring
    double max_strain = 0.0;  ///< [-]
    /// [-] Largest kinetic + elastic + potential energy after the throw over that at the throw.
    double energy_ratio = 0.0;
    double end_energy = 0.0; ///< [-] at the end over that at the throw; below 0 where cloth has fallen
    bool is_finite = true;
    bool holds = false; ///< finite, nothing crossed, energy bounded
};

/// A case with all its seeds: the worst of each, but means of contacts, iterations and times.
struct StressResult {
    StressCase trial;
    std::vector<StressRun> runs;
    StressRun worst; ///< its seed: the first that does not hold, 0 when all do
};

/// Runs a case with one seed.
/// @param scene       stress_scene() of the case and the seed
/// @param after_step  called with the number of steps done; false breaks the run off
StressRun run(const StressCase& trial, unsigned seed, const Scene& scene,
              const std::function<bool(int)>& after_step);

/// @param runs  at least one
StressResult summarise(const StressCase& trial, std::vector<StressRun> runs);

} // namespace toile::contact
