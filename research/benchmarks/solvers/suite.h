#pragma once

#include <string>
#include <vector>

#include "research/benchmarks/solvers/methods.h"

namespace toile::research::solvers {

/// A problem of the table and its sampling.
struct Case {
    Problem problem;
    int steps = 0;  ///< sampled
    int stride = 0; ///< steps between samples
};

/// Every problem of the table, or four small ones.
/// @param mesh  "NAME" selects the problems of a mesh, "NAME:VERTICES" makes one of that size at 1e3 N/m, a
///              bar at 2e5 Pa, and 1/120 s; empty: all
/// @throws InvalidInput  naming an unknown mesh, or a size that is no number or outside 50 to 200 000
std::vector<Case> choose_cases(const std::string& mesh, bool quick);

/// All methods whose name contains `only`.
/// @throws InvalidInput  if there is none
std::vector<Method> choose_methods(const std::string& only);

} // namespace toile::research::solvers
