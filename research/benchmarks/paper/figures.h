#pragma once

#include "research/benchmarks/paper/curve.h"

/// Ablations and comparisons of the paper's section 7 on a CPU, on own problems of the same kind. Beside the
/// paper's residual stands the error to a direct solve or to the converged step: where iterations move
/// little, a small residual is no small error.
namespace toile::research::paper {

/// Size of a measurement.
struct Effort {
    int vertices = 0;     ///< of a problem, about
    double seconds = 0.0; ///< of repetitions of each timing; the fastest counts
};

/// Figures 7 (near field by a Gaussian or by Gauss-Legendre), 8 (stacked or subdivided) and 9 (shares of the
/// fields, number of clusters): the global step H x = b of bars of tetrahedra and of sheets, soft and stiff,
/// for a sharp force ("drag") and for the gradient of a step of the swinging body ("swing").
///
/// Loops: "plain" is the paper's, x += rule(b - H x); "line search" scales each step by the best factor of
/// either sign; "pcg" is the flexible conjugate gradient around the rule. Errors are in the norm of H.
std::vector<Curve> rule_curves(const Effort& effort);

/// Figure 11: the nested preconditioner against its contact operator alone, on the global step with contact
/// of stacked sheets and bars. Flexible conjugate gradients; errors are in the norm of H + dH.
std::vector<Curve> contact_curves(const Effort& effort);

/// Figure 12: steps of a bar, and of a sheet that drapes over a ball, by local/global iterations around each
/// global solver, by JGS2 and by Toile's Newton's method. Errors are distances to the converged step.
///
/// Loops: "plain" takes full steps; "line search" backtracks; "l-bfgs" is Toile's L-BFGS.
std::vector<Curve> step_curves(const Effort& effort);

} // namespace toile::research::paper
