#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/backend/cuda/device.h"
#include "scenes/format/scene.h"

namespace toile {

/// Where a World minimises its steps.
enum class Backend {
    Cpu,
    Cuda, ///< a GPU; refused where there is none or the scene needs the CPU
    Auto  ///< a GPU where there is one with room and the scene can, else the CPU
};

/// Why a scene does not run on a GPU, e.g. `solver.method "multigrid" runs on the CPU only`; empty where it
/// does.
std::string why_not_on_gpu(const Scene& scene);

/// @throws InvalidInput  why_not_on_gpu() as an error of the scene's file, with what to do
void require_runs_on_gpu(const Scene& scene);

/// The GPU that a scene is to run on; null: the CPU.
/// @param device  number of the GPU where it is not the CPU
/// @param warn  told why it is not a GPU where Auto takes the CPU; may be empty
/// @throws InvalidInput where the scene asked for Cuda needs the CPU, DeviceError where there is no such GPU
std::shared_ptr<const CudaSpace> open_backend(Backend backend, int device, const Scene& scene,
                                              const std::function<void(const std::string&)>& warn);

/// What open_backend() has opened, or null where a scene of so many vertices of cloth may find no room there:
/// by an estimate that is rather too large, from what scenes took whose garments touch
/// (docs/benchmarks/gpu.md).
/// @param warn  told both sizes then; may be empty
std::shared_ptr<const CudaSpace> where_there_is_room(std::shared_ptr<const CudaSpace> space, long vertices,
                                                     const std::function<void(const std::string&)>& warn);

} // namespace toile
