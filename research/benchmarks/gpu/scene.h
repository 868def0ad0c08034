#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/compute/cuda/runtime/device.h"
#include "core/compute/types.h"
#include "core/pd/step/step_stop.h"
#include "scenes/format/scene.h"

namespace toile::research::gpu {

/// A scene file and the frames to run.
struct SceneCase {
    std::string name;
    std::filesystem::path file; ///< from the root of the repository
    int frames = 0;             ///< after the start pose
    int cpu_frames = 0; ///< number of them run on the CPU too; then the GPU has a row for these as well
    int substeps = 0;   ///< per frame, instead of the scene's; 0: the scene's
    std::optional<StepStop> stop = {}; ///< instead of the scene's
    double move = 1e-3;                ///< change of positions at which L-BFGS ends [m]
    bool keeps_solver = false;         ///< the scene's own, instead of L-BFGS
    scene::SolverMethod method = scene::SolverMethod::Quadrature; ///< with L-BFGS
    double velocity_tolerance = 0.0; ///< [m/s] instead of the scene's with keeps_solver; 0: the scene's
    int sample_frame = 0;            ///< whose positions SceneRun::sample has; 0: none
    bool needs_data = false;         ///< skipped if TOILE_DATA_DIR lacks files of the scene
};

/// Cost of the first frames of a scene on one backend, mean per step [ms].
struct SceneRun {
    std::string name, backend;
    std::string skipped; ///< reason for not running; empty: it ran
    int vertices = 0, bodies = 0, frames = 0, steps = 0;
    double dt = 0.0;                                  ///< [s]
    double iterations = 0.0, linear_iterations = 0.0; ///< per step
    double contacts = 0.0;                            ///< active pairs at the end of a frame, mean
    int frames_at_limit = 0;                          ///< with a step that reached the iteration limit
    int crossings_before = 0;                         ///< crossing pairs of triangles, after settling
    int crossings = 0;                                ///< at the end
    double max_strain = 0.0;                          ///< [-] maximum of all frames
    double total_ms = 0.0;
    double slowest_ms = 0.0;  ///< per step of the slowest frame
    double cull_ms = 0.0;     ///< search for pairs with colliders and of cloth, both phases
    double narrow_ms = 0.0;   ///< test which pairs press, their terms, collision-free step
    double minimise_ms = 0.0; ///< descents: local steps, global solves, PCG; Newton's Hessians and solves
    double limit_ms = 0.0;    ///< strain limits
    double load_s = 0.0;      ///< meshes and start pose
    double prepare_s = 0.0;   ///< factors and tables
    double settle_s = 0.0;
    double device_gb = 0.0;   ///< used on the GPU at the end
    std::vector<Vec3> sample; ///< [vertices of all surfaces] at SceneCase::sample_frame [m]
};

/// Runs a case on the GPU of `space`, and on the CPU if the case asks for it.
/// @throws as World, except for missing data
std::vector<SceneRun> measure_scene(const CudaSpace& space, const SceneCase& what);

/// Tables of the cost of a step, then of preparation and final state.
std::string markdown_of(const std::vector<SceneRun>& runs);
std::string csv_of(const std::vector<SceneRun>& runs);

} // namespace toile::research::gpu
