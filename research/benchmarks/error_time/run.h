#pragma once

#include <functional>
#include <string>
#include <vector>

#include "research/benchmarks/error_time/problems.h"

namespace toile::research::error_time {

/// A contender's point in the plane of time and error.
struct Point {
    std::string problem, quantity, method, setting;
    bool is_default = false;
    double ms_per_frame = 0.0;
    double error = 0.0;
    int unfinished = 0; ///< frames with a step that ended at a limit
    int frames = 0;
};

/// Runs the reference of a problem, then all contenders. Methods of the literature have points only where
/// cloth meets no cloth: XPBD and vertex block descent know no such contact, and the others take minutes.
/// @param after_frame  called after every frame with the contender's name; false stops the run
std::vector<Point> run(const accuracy::Case& problem, const std::vector<Contender>& contenders,
                       const std::function<bool(const std::string& name)>& after_frame);

/// Frames that run() simulates.
int frames_of(const accuracy::Case& problem, const std::vector<Contender>& contenders);

std::string markdown_table(const std::vector<Point>& points);
std::string csv_table(const std::vector<Point>& points);

} // namespace toile::research::error_time
