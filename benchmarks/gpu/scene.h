#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/backend/cuda/device.h"
#include "core/pd/step_stop.h"

namespace toile::gpu {

/// A scene file and what of it is run.
struct SceneCase {
    std::string name;
    std::filesystem::path file; ///< from the root of the repository
    int frames = 0;             ///< after the start
    int cpu_frames = 0;         ///< so many of them on the CPU too; then the GPU has a row of these as well
    int substeps = 0;           ///< of a frame, instead of the scene's; 0: the scene's
    std::optional<StepStop> stop = {}; ///< instead of the scene's
    bool needs_data = false;           ///< skipped where TOILE_DATA_DIR has not what the scene reads
};

/// What the first frames of a scene cost on one backend: milliseconds of a step, on average.
struct SceneRun {
    std::string name, backend;
    std::string skipped; ///< why nothing was run; empty: it was
    int vertices = 0, frames = 0, steps = 0;
    double dt = 0.0;                                  ///< [s]
    double iterations = 0.0, linear_iterations = 0.0; ///< of a step
    double contacts = 0.0;                            ///< pairs that act at the end of a frame, mean
    int frames_at_limit = 0;                          ///< with a step that the iteration limit ended
    int crossings_before = 0;                         ///< pairs of cloth's triangles that cross, settled
    int crossings = 0;                                ///< at the end
    double max_strain = 0.0;                          ///< [-] of all frames
    double total_ms = 0.0;
    double slowest_ms = 0.0;  ///< of a step of the slowest frame
    double cull_ms = 0.0;     ///< pairs with colliders and of cloth, by both phases of the search
    double narrow_ms = 0.0;   ///< which pairs press, their terms, cloth kept from crossing
    double minimise_ms = 0.0; ///< descents: local steps, global solves, PCG
    double limit_ms = 0.0;    ///< strain limits
    double load_s = 0.0;      ///< meshes, and a start pose without crossings
    double prepare_s = 0.0;   ///< factors and tables
    double settle_s = 0.0;
    double device_gb = 0.0; ///< taken on the GPU at the end
};

/// Runs a case on the CPU, where it asks for that, and on the GPU of `space`.
/// @throws as World, but for data that is not there
std::vector<SceneRun> measure_scene(const CudaSpace& space, const SceneCase& what);

/// What a step costs, and then what it takes to get there and how it ended.
std::string markdown_of(const std::vector<SceneRun>& runs);
std::string csv_of(const std::vector<SceneRun>& runs);

} // namespace toile::gpu
