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

/// All frames of a case's scene, or of another one with the same cloth.
struct Run {
    Trajectory trajectory;
    double seconds = 0.0; ///< [s] in steps
    int unfinished = 0;   ///< frames with a step that ended at a limit
    bool is_complete = true;
};
Run run_scene(const Case& trial, const scenes::Scene& scene, const scenes::WorldOptions& options,
              const std::function<bool()>& after_frame);

/// Right value of a case, and the error of a value against it.
/// @param converged  run of the reference; null without
double right_value(const Case& trial, const Trajectory* converged);
double error_of(const Case& trial, double value, double right);

/// Runs a case and, on the CPU, its reference.
/// @param after_frame  called after every frame; false stops the case
Result run(const Case& trial, const scenes::WorldOptions& options, const std::function<bool()>& after_frame);

/// Frames that run() simulates, reference included.
int frames_of(const Case& trial);

/// One line per case, columns aligned: for terminals and for Markdown.
std::string markdown_table(const std::vector<Result>& results);
std::string csv_table(const std::vector<Result>& results);

} // namespace toile::research::accuracy
