#pragma once

#include <limits>
#include <string>

namespace toile {

/// Largest error of a step [m] where none is refused.
inline constexpr double kAnyStepError = std::numeric_limits<double>::infinity();

/// Outcome of one or several time steps. Numerical problems are reported here, never thrown.
struct StepReport {
    /// What was reached, the worst last.
    enum class Status {
        Converged,      ///< the last move fell below the tolerance, and nothing had to yield
        IterationLimit, ///< stopped at the iteration limit; displacement measures the remaining error
        Yielded,        ///< the strain limit had to yield, or exactly held vertices
        Pinched,        ///< there is no room between body parts: cloth lets one of them through
        Stuck,          ///< cloth crosses a body that has closed on it, or that it crossed before
        NonFinite,      ///< the first non-finite energy stopped the run; message names it
    };

    /// What one status is about.
    struct Findings {
        int count = 0;
        std::string place; ///< of the first or worst; empty if there is none
        void merge(const Findings& other);
    };

    Status status = Status::Converged;
    int steps = 0;
    int unfinished = 0;         ///< of these, steps that ended at the iteration limit
    int refused = 0;            ///< beside these, steps that were not taken: their error was too large
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
    Findings yielded;           ///< triangles beyond their strain limit by more than is tolerated
    Findings pulled;            ///< likewise, with all corners attached: what holds them has stretched them
    Findings displaced;         ///< exactly held vertices that contact keeps off their targets
    Findings pinched;           ///< vertices that let a body part through
    Findings stuck;             ///< triangles of cloth that cross a body
    std::string message;        ///< empty unless status is NonFinite

    /// Combines with the report of another step or body: counts add, extremes are kept, worst status wins.
    void merge(const StepReport& other);
};

} // namespace toile
