#pragma once

#include "core/linear/supernodal_factor.h"
#include "core/quadrature/quadrature_operator.h"

namespace toile {

/// What the global step of one body costs on this machine, as busy as it is now.
struct SolveCosts {
    /// Solves with quadrature for one with the factor [-]: being inexact, it takes 5 to 10 % more iterations.
    static constexpr double kMoreSolves = 1.08;

    /// Gain [-] below which quadrature is not worth giving up reproducible last bits for; timings of a busy
    /// machine are no more certain than that.
    static constexpr double kWorthwhile = 1.15;

    double direct = 0.0;     ///< [s] one solve with the factor
    double quadrature = 0.0; ///< [s] one application of the tables
    double build = 0.0;      ///< [s] building them on one thread

    /// What a solve with the factor loses against quadrature [s]; negative where it gains.
    double loss() const { return direct - kMoreSolves * quadrature; }

    /// True where quadrature is faster by a worthwhile share.
    bool pays() const { return direct > kWorthwhile * kMoreSolves * quadrature; }
};

/// Numbers that quadrature reads per node of a surface, at the default tolerance: 168 (n / 10 000)^0.215,
/// fitted to docs/core/quadrature.md (2 500 to 50 176 vertices).
double expected_gathers(int vertex_count);

/// Costs of tables that do not exist yet, found by doing some of the work: solves with the factor, a pass
/// over a table of the expected size with arbitrary weights, one block of columns of the inverse. Costs about
/// as much as thirty solves; 64 MB at most.
SolveCosts expected_costs(const SupernodalFactor& factor);

/// Costs of tables that exist; building them is 0.
SolveCosts measured_costs(const SupernodalFactor& factor, const QuadratureOperator& quadrature);

} // namespace toile
