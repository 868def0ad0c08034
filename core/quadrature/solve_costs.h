#pragma once

#include "core/linear/supernodal_factor.h"
#include "core/quadrature/quadrature_operator.h"

namespace toile {

/// Costs of the global step of one body on this machine, at its current load.
struct SolveCosts {
    /// Solves with quadrature per solve with the factor [-]: being inexact, it takes 5 to 10 % more
    /// iterations.
    static constexpr double kMoreSolves = 1.08;

    /// Gain [-] below which quadrature does not repay the loss of reproducible last bits. Timings on a busy
    /// machine have about this uncertainty.
    static constexpr double kWorthwhile = 1.15;

    double direct = 0.0;     ///< [s] one solve with the factor
    double quadrature = 0.0; ///< [s] one application of the tables
    double build = 0.0;      ///< [s] building them on one thread

    /// Time that a solve with the factor loses against quadrature [s]; negative if the factor is faster.
    double loss() const { return direct - kMoreSolves * quadrature; }

    /// True if quadrature is faster by a worthwhile factor.
    bool pays() const { return direct > kWorthwhile * kMoreSolves * quadrature; }
};

/// Numbers that quadrature reads per node of a surface at the default tolerance: 168 (n / 10 000)^0.215,
/// fitted to docs/journal/quadrature.md (2 500 to 50 176 vertices).
double expected_gathers(int vertex_count);

/// Estimated costs of tables that do not exist yet, from a part of the work: solves with the factor, a pass
/// over a table of the expected size with arbitrary weights, one block of columns of the inverse. Takes about
/// as long as thirty solves and at most 64 MB.
SolveCosts expected_costs(const SupernodalFactor& factor);

/// Measured costs of existing tables; `build` is 0.
SolveCosts measured_costs(const SupernodalFactor& factor, const QuadratureOperator& quadrature);

} // namespace toile
