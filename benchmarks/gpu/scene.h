#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scenes/backend.h"

namespace toile::gpu {

/// A scene file and what of it is run.
struct SceneCase {
    std::string name;
    std::filesystem::path file; ///< from the root of the repository
    int frames = 0;             ///< after the start
    bool on_cpu = true;         ///< also there, to compare with
};

/// What the steps of a scene cost on one backend: milliseconds of a step, on average.
struct SceneRun {
    std::string name, backend;
    int vertices = 0, steps = 0;
    double iterations = 0.0, linear_iterations = 0.0; ///< of a step
    int contacts = 0;                                 ///< at the end
    int crossings = 0;                                ///< pairs of triangles that cross, at the end
    double total_ms = 0.0;
    double search_ms = 0.0;   ///< pairs looked for, with colliders and with cloth
    double apart_ms = 0.0;    ///< cloth kept from crossing, its own searches included
    double minimise_ms = 0.0; ///< descents: local steps, global solves, PCG
    double limit_ms = 0.0;    ///< strain limits
};

/// Runs a case on the CPU, where it asks for that, and on the GPU. @throws as World
std::vector<SceneRun> measure_scene(const SceneCase& what);

std::string markdown_of(const std::vector<SceneRun>& runs);
std::string csv_of(const std::vector<SceneRun>& runs);

} // namespace toile::gpu
