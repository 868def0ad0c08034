#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "benchmarks/contact/parts.h"
#include "scenes/format/scene.h"

namespace toile::contact {

/// Detection should take no more of a step than this [-].
inline constexpr double kMostDetection = 0.5;

/// Scene files of dressed bodies, from the root of the repository; those below scenes/data need the data set.
const std::vector<std::filesystem::path>& dressed_scenes();

/// The same frames of a scene with contact of cloth with itself and without, means per step.
struct DressedResult {
    std::string name;
    int vertices = 0;
    int frames = 0;          ///< after settling
    double contacts = 0.0;   ///< pairs that push, at the end of a frame
    double iterations = 0.0; ///< per step
    double iterations_without = 0.0;
    PartSeconds with{};    ///< [s]
    PartSeconds without{}; ///< [s]

    double ratio() const { return step_seconds(with) / step_seconds(without); }
    double detection_share() const { return detection_seconds(with) / step_seconds(with); }
    bool detects_too_long() const { return detection_share() > kMostDetection; }
};

/// Simulates both, by the direct solver, frame by frame in turn: what else the machine does meets both alike.
/// @param scene        its number of frames counts
/// @param after_frame  called with the number of frames done by both; false breaks the run off
DressedResult run(Scene scene, int threads, const std::function<bool(int)>& after_frame);

} // namespace toile::contact
