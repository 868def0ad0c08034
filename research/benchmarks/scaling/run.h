#pragma once

#include <functional>
#include <string>
#include <vector>

#include "research/benchmarks/power_fit.h"
#include "scenes/format/scene.h"

namespace toile::research::scaling {

/// Means over the frames of one scene at one resolution.
struct Result {
    int vertices = 0;
    double ms_per_frame = 0.0;
    double iterations = 0.0; ///< of Newton's method, per frame
    double contacts = 0.0;
    double self_collision = 0.0;   ///< [-] share of the search for near cloth and of the collision-free step
    double bytes_per_vertex = 0.0; ///< peak memory beyond that at the start of the run
};

/// The scene with a rectangle as its only cloth, cut into about this many vertices.
/// @throws InvalidInput  naming the scene if its cloth is something else
scenes::Scene with_vertices(scenes::Scene scene, int vertices);

/// @param after_frame  called with the number of frames done; false stops the run
Result run(const scenes::Scene& scene, const std::function<bool(int)>& after_frame);

/// Milliseconds a frame as a power of the vertices.
PowerFit fit(const std::vector<Result>& results);

std::string markdown_table(const std::vector<Result>& results);
std::string csv_table(const std::vector<Result>& results);

} // namespace toile::research::scaling
