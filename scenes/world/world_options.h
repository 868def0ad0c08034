#pragma once

#include <functional>
#include <memory>
#include <string>

#include "scenes/world/backend.h"

namespace toile {
class TableStore;
} // namespace toile

namespace toile::scenes {

class BaselineMethods;

/// Options of a World beyond the scene.
struct WorldOptions {
    Backend backend = Backend::Cpu;
    int device = 0; ///< number of the GPU for Backend::Cuda and Auto (cuda_devices())

    /// Methods of the literature, borrowed; null: a scene that names one is an error.
    const BaselineMethods* baselines = nullptr;

    /// Store of quadrature tables; null: TableStore::of_process(), which keeps them on disk.
    std::shared_ptr<TableStore> tables = nullptr;

    /// Called with a cloth's name and the finished fraction [0, 1] of its tables during construction, from
    /// any of the building threads. Returning false ends the building call with Cancelled. May be empty.
    std::function<bool(const std::string& cloth, double fraction)> building = nullptr;

    /// Called with what is done and its finished fraction [0, 1]: loading, repair and relaxation of the start
    /// pose, preparation, settling, the steps of a sample ("step 3, iteration 41" within one). May be empty.
    std::function<void(const std::string& task, double fraction)> progress = nullptr;

    /// Asked often, on the calling thread: false ends the constructor, prepare(), settle() or advance_frame()
    /// with Cancelled. May be empty.
    std::function<bool()> goes_on = nullptr;

    /// Receives problems that do not stop the run, e.g. a damaged cache file; may be empty.
    std::function<void(const std::string&)> warn = nullptr;

    /// Receives what was chosen where the scene leaves it open, e.g. a cloth's uv_scale; may be empty.
    std::function<void(const std::string&)> note = nullptr;
};

} // namespace toile::scenes
