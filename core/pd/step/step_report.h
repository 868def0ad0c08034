#pragma once

#include <string>

namespace toile {

/// Outcome of one or several time steps. Numerical problems are reported here, never thrown.
struct StepReport {
    enum class Status {
        Converged,      ///< the last move fell below the tolerance
        IterationLimit, ///< stopped at the iteration limit; displacement measures the remaining error
        NonFinite,      ///< the first non-finite energy stopped the run; message names it
    };

    Status status = Status::Converged;
    int steps = 0;
    int iterations = 0;         ///< outer iterations, summed over steps
    int linear_iterations = 0;  ///< PCG iterations inside them, summed
    double displacement = 0.0;  ///< [m] largest vertex move of the last outer iteration, worst step
    double speed = 0.0;         ///< [m/s] RMS of the last Newton step per time, worst step; 0: other methods
    double step_error = 0.0;    ///< [m] RMS local error of time integration by estimate, worst step
    double gradient_norm = 0.0; ///< [N] largest residual force on a vertex, worst step
    double energy = 0.0;        ///< [J] objective of the last step
    int contacts = 0;           ///< active contact pairs at the end of the last step
    double min_gap = 0.0;       ///< [m] smallest signed gap of a contact candidate; 0 without candidates
    double max_strain = 0.0;    ///< [-] largest principal stretch - 1 after strain limiting
    std::string message;        ///< empty unless status is NonFinite

    /// Combines with the report of another step or body: counts add, extremes are kept, worst status wins.
    void merge(const StepReport& other);
};

} // namespace toile
