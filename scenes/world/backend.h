#pragma once

#include <functional>
#include <memory>
#include <string>

#include "scenes/format/scene.h"

namespace toile {
class CudaSpace;
} // namespace toile

namespace toile::scenes {

struct SceneCosts;

/// Machine on which a World minimises its steps.
enum class Backend {
    Cpu,
    Cuda, ///< a GPU; an error if there is none or the scene needs the CPU
    Auto  ///< a GPU if one has enough memory and supports the scene, else the CPU
};

/// Reason why a scene can't run on a GPU, e.g. `solver.method "multigrid" runs on the CPU only`; empty if it
/// can.
std::string why_not_on_gpu(const Scene& scene);

/// @throws InvalidInput  why_not_on_gpu() as an error of the scene's file, with a remedy
void require_runs_on_gpu(const Scene& scene);

/// Opens the GPU for a scene; null: the CPU.
/// @param device  number of the GPU
/// @param warn    receives the reason if Auto falls back to the CPU; may be empty
/// @throws InvalidInput if Cuda is requested and the scene needs the CPU, DeviceError if there is no such GPU
std::shared_ptr<const CudaSpace> open_backend(Backend backend, int device, const Scene& scene,
                                              const std::function<void(const std::string&)>& warn);

/// Returns `space`, or null if Auto takes the CPU because the scene may not fit into its memory.
/// @param warn  receives both sizes if it does not fit; may be empty
/// @throws DeviceError if Cuda is requested and the scene can't fit
std::shared_ptr<const CudaSpace> space_with_capacity(std::shared_ptr<const CudaSpace> space, Backend backend,
                                                     const SceneCosts& costs,
                                                     const std::function<void(const std::string&)>& warn);

} // namespace toile::scenes
