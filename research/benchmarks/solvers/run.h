#pragma once

#include "research/benchmarks/solvers/methods.h"

namespace toile::research::solvers {

/// Results of one method on one problem.
struct Result {
    std::string mesh;
    int vertices = 0;
    double stiffness = 0.0; ///< [N/m]; [Pa] of a solid
    double dt = 0.0;        ///< [s]
    std::string method;
    int threads = 0;
    double setup_ms =
        0.0; ///< matrices, factors, tables, colours: time of the first step with set-up, less a step
    double step_ms = 0.0;    ///< wall clock, mean over the sampled steps, minimum of the repeats
    double iterations = 0.0; ///< outer iterations, sweeps or substeps per step, mean
    double gradients = 0.0;  ///< evaluations of energy and gradient per step, mean; 0 for baseline methods
    double solves = 0.0;     ///< applications of the direct solver's H^-1 per step, mean; 0 for other solvers
    /// RMS distance of vertices from the converged minimiser, in mean edges: root mean square over the steps.
    double rms_over_edge = 0.0;
    double energy_gap = 0.0;            ///< [-] (E - E*) / (E(q*) - E*), mean over the steps
    bool is_reference_converged = true; ///< false: errors below the reference's own error are meaningless
    double peak_mb = 0.0;               ///< peak added to the process by set-up and first step [MB]
};

/// Quadrature tables of one problem, which take half a minute at 50 000 vertices. The first method builds
/// them for all others, whose results include the same time and memory.
struct KeptTables {
    std::unique_ptr<Stepper> owner;
    double build_ms = 0.0;
    double peak_mb = 0.0; ///< of the owner's set-up
};

/// @param kept  null: every method builds its own tables
Result run(const Problem& problem, const std::vector<SampledStep>& steps, const Method& method, int repeats,
           KeptTables* kept = nullptr);

std::string csv_table(const std::vector<Result>& results);
std::string markdown_table(const std::vector<Result>& results);

} // namespace toile::research::solvers
