#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "research/benchmarks/contact/parts.h"
#include "scenes/format/scene.h"

namespace toile::research::contact_stress {

/// Target maximum of detection over step time [-].
inline constexpr double kMaxDetection = 0.5;

/// Scene files of dressed bodies, relative to the root of the repository; those below scenes/data need the
/// data set.
const std::vector<std::filesystem::path>& dressed_scenes();

/// Equal frames of a scene with and without contact of cloth with itself, means per step.
struct DressedResult {
    std::string name;
    int vertices = 0;
    int frames = 0;          ///< after settling
    double contacts = 0.0;   ///< active pairs at the end of a frame
    double iterations = 0.0; ///< per step
    double iterations_without = 0.0;
    PartSeconds with{};    ///< [s]
    PartSeconds without{}; ///< [s]

    double ratio() const { return step_seconds(with) / step_seconds(without); }
    double detection_fraction() const { return detection_seconds(with) / step_seconds(with); }
    bool detects_too_long() const { return detection_fraction() > kMaxDetection; }
};

/// Simulates both with the direct solver, alternating frame by frame, so that other load of the machine
/// affects both alike.
/// @param scene        its number of frames is used
/// @param after_frame  called with the number of frames done by both; false stops the run
DressedResult run(scenes::Scene scene, int threads, const std::function<bool(int)>& after_frame);

} // namespace toile::research::contact_stress
