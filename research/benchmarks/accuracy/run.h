#pragma once

#include <functional>
#include <string>
#include <vector>

#include "research/benchmarks/accuracy/cases.h"
#include "scenes/world/world_options.h"

namespace toile::research::accuracy {

struct Result {
    std::string name, quantity;
    std::string from; ///< "exact" or "converged"
    double right = 0.0, value = 0.0, error = 0.0, aim = 0.0;
    bool holds = false;
    double ms_per_frame = 0.0;
    int unfinished = 0; ///< frames with a step that ended at a limit
    int frames = 0;
};

/// Runs a case and, on the CPU, its reference.
/// @param after_frame  called after every frame; false stops the case
Result run(const Case& trial, const scenes::WorldOptions& options, const std::function<bool()>& after_frame);

/// Frames that run() simulates, reference included.
int frames_of(const Case& trial);

/// One line per case, columns aligned: for terminals and for Markdown.
std::string markdown_table(const std::vector<Result>& results);
std::string csv_table(const std::vector<Result>& results);

} // namespace toile::research::accuracy
