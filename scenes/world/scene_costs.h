#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenes/format/scene.h"
#include "scenes/world/bodies/scene_bodies.h"
#include "scenes/world/scene_cloth.h"

namespace toile::scenes {

/// Expected cost of a scene before its quadrature tables and its arrays on a GPU are made.
struct SceneCosts {
    long cloth_vertices = 0, body_vertices = 0; ///< of soft bodies, inner ones included
    int parts = 0;                              ///< cloths and soft bodies
    int tables = 0;                             ///< different ones: equal parts share theirs
    double table_seconds = 0.0;                 ///< [s] if none of them is stored
    double table_bytes = 0.0;                   ///< [bytes]

    /// Memory of a GPU, tables included [bytes]: that of a scene in which nothing touches, and that of one
    /// with as many pairs in contact as were measured (docs/performance.md#memory). Both are 0 on a CPU.
    std::size_t min_bytes = 0, max_bytes = 0;

    long vertex_count() const { return cloth_vertices + body_vertices; }
};

/// Two parts share tables if mesh, material and density are equal, and neither is attached nor has a core:
/// attached parts that are equal are counted twice.
/// @param on_gpu  else on the CPU, with all its threads
SceneCosts expected_costs(const Scene& scene, const std::vector<SceneCloth>& cloths,
                          const SceneBodies& bodies, bool on_gpu);

/// Likewise of a scene whose files are not loaded yet.
/// @throws InvalidInput for a file, mesh, fabric or attachment that does not work
SceneCosts expected_costs(const Scene& scene, bool on_gpu);

/// E.g. "11 quadrature tables for 17 cloths and bodies of 177533 vertices: about 3.4 s to build if none is
/// stored, 0.35 kB a vertex".
std::string table_text(const SceneCosts& costs);

/// Memory that a GPU has left.
struct FreeMemory {
    std::string device; ///< CudaSpace::described()
    std::size_t bytes = 0;
};

/// E.g. "memory of the GPU: 970 to 3540 MiB, 6 to 21 kB a vertex".
std::string memory_text(const SceneCosts& costs);

/// Likewise, with "; 80200 MiB are free".
std::string memory_text(const SceneCosts& costs, const FreeMemory& free);

/// Reason why a scene may not fit; empty if it does.
std::string why_too_large(const SceneCosts& costs, const FreeMemory& free);

/// @throws DeviceError if a scene can't fit, naming its size, the free one and a remedy
void require_capacity(const SceneCosts& costs, const FreeMemory& free);

} // namespace toile::scenes
