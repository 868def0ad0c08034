#pragma once

#include <string>
#include <vector>

#include "research/benchmarks/accuracy/cases.h"

namespace toile::research::error_time {

/// Cases of accuracy with a converged run, and sheets that hang from two corners: 2 500 and, unless quick, 10
/// 000 vertices.
std::vector<accuracy::Case> problems(bool quick);

/// A way of taking the steps of a problem.
struct Contender {
    std::string method;  ///< a curve: values of one setting
    std::string setting; ///< the value
    scene::Solver solver;
    bool is_default = false;
};
std::vector<Contender> contenders(bool quick);

} // namespace toile::research::error_time
