#pragma once

#include "benchmarks/solvers/methods.h"

namespace toile::solvers {

/// One method on one problem.
struct Result {
    std::string mesh;
    int vertices = 0;
    double stiffness = 0.0; ///< [N/m]
    double dt = 0.0;        ///< [s]
    std::string method;
    int threads = 0;
    double setup_ms =
        0.0;              ///< matrices, factors, tables, colours: until the first step has ended, less a step
    double step_ms = 0.0; ///< wall clock, mean over the sampled steps, the fastest of the repeats
    double iterations = 0.0; ///< outer iterations, sweeps or substeps a step, mean
    double gradients = 0.0;  ///< evaluations of energy and gradient a step, mean; 0 for rivals
    double solves = 0.0;     ///< applications of the direct solver's H^-1 a step, mean; 0 for other solvers
    /// RMS distance of a vertex from the converged minimiser, in mean edges: root mean square over the steps.
    double rms_over_edge = 0.0;
    double energy_gap = 0.0;            ///< [-] (E - E*) / (E(q*) - E*), mean over the steps
    bool is_reference_converged = true; ///< false: the errors are no better than the reference
    double peak_mb = 0.0;               ///< that set-up and the first step add to the process, at most [MB]
};

/// Quadrature tables of one problem, which take half a minute at 50 000 vertices: the first method that
/// builds them keeps them for the others, whose results count the same time and memory.
struct KeptTables {
    std::unique_ptr<Stepper> owner;
    double build_ms = 0.0;
    double peak_mb = 0.0; ///< of the owner's set-up
};

/// @param kept  null: every method builds its own
Result run(const Problem& problem, const std::vector<SampledStep>& steps, const Method& method, int repeats,
           KeptTables* kept = nullptr);

std::string csv_table(const std::vector<Result>& results);
std::string markdown_table(const std::vector<Result>& results);

} // namespace toile::solvers
