#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/compute/types.h"

namespace toile::research::paper {

/// Convergence of a method on one problem of a figure.
struct Curve {
    /// State after a number of iterations.
    struct Point {
        int iterations = 0;    ///< made: fewer than asked for if the method found no direction
        double ms = 0.0;       ///< wall clock of them all
        double residual = 0.0; ///< [-] the paper's: |b - H x| over that at the start; of a step, |gradient|
        double error = 0.0; ///< [-] distance to the solution over that at the start; infinite if it overflows
    };
    int figure = 0; ///< of the paper
    std::string problem, method;
    std::string loop; ///< around the method
    double setup_ms = 0.0;
    std::vector<Point> points; ///< iterations ascending, or equal where the method has ended
};

/// Error whose time markdown_of() lists [-].
inline constexpr double kReached = 1e-2;

/// Appends a point for each number of iterations.
/// @param seconds  of repetitions of each timing
/// @param solve  solve(iterations): runs from the start, and returns how many it has made
/// @param judge  judge(point): sets residual and error of what solve() has left
void trace(Curve& curve, View<const int> iterations, double seconds, const std::function<int(int)>& solve,
           const std::function<void(Curve::Point&)>& judge);

std::string csv_of(const std::vector<Curve>& curves);

/// One row for the curves of a method, which follow each other: "residual / error" after one iteration of the
/// first loop and after all iterations of each, and the least time to kReached.
std::string markdown_of(const std::vector<Curve>& curves);

} // namespace toile::research::paper
