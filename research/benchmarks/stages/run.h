#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/format/scene.h"

namespace toile::research::stages {

/// Time of a stage per frame. Stages contain each other: fractions do not add up to 1.
struct Stage {
    std::string name;
    double calls = 0.0;
    double ms = 0.0;
    double fraction = 0.0; ///< [-] of the frame
};

/// Results of a scene's frames after settling.
struct Result {
    std::string name;
    int vertices = 0;
    int frames = 0;
    double ms_per_frame = 0.0;
    double median_ms = 0.0;
    double slowest_ms = 0.0;
    double user_ms = 0.0;      ///< processor time of all threads per frame
    double iterations = 0.0;   ///< outer iterations per frame
    double contacts = 0.0;     ///< at the end of a frame, mean
    double load_s = 0.0;       ///< [s] reading, placing and settling
    long peak_memory = 0;      ///< [bytes] of the process so far
    std::vector<Stage> stages; ///< those of at least kMinStageFraction, longest first
};

inline constexpr double kMinStageFraction = 0.01;

/// Simulates a scene to its last frame.
/// @param after_frame  called with the number of frames done; false stops the run
Result run(const scenes::Scene& scene, const std::function<bool(int)>& after_frame);

} // namespace toile::research::stages
