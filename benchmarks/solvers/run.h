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
    double peak_mb = 0.0;               ///< of the process so far [MB]
};

Result run(const Problem& problem, const std::vector<SampledStep>& steps, const Method& method, int repeats);

std::string csv_table(const std::vector<Result>& results);
std::string markdown_table(const std::vector<Result>& results);

} // namespace toile::solvers
