#pragma once

#include <filesystem>

#include "apps/toile/interrupt.h"
#include "apps/toile/run_log.h"
#include "apps/toile/table_progress.h"
#include "scenes/world.h"

namespace toile {

/// A scene and the places of what its run leaves.
struct SceneJob {
    Scene scene;
    std::filesystem::path folder; ///< of caches and certificate
    std::filesystem::path report; ///< empty: none
};

/// How scenes are run.
struct RunSettings {
    Backend backend = Backend::Cpu;
    int device = 0; ///< number of the GPU, where it is one
    bool no_cache = false;
    bool no_check = false;
};

/// One scene of `toile simulate`, from its files to its caches, report and certificate. Used by one thread.
class SceneRun {
public:
    /// Loads and places everything.
    /// @param job  outlives the run
    /// @throws as World's constructor
    SceneRun(const SceneJob& job, const RunSettings& settings, RunLog log);

    /// Prepares, simulates, writes and checks.
    /// @return kExitOk, or kExitFailure once it is said why: a failure, an interrupt, a certificate that does
    ///         not hold
    /// @throws InvalidInput or DeviceError where files can't be written or the GPU refuses
    int run(const InterruptGuard& interrupt);

private:
    WorldOptions world_options(const RunSettings& settings);
    int run_into_caches(const InterruptGuard& interrupt);

    const SceneJob& job_;
    bool no_check_;
    RunLog log_;
    TableProgress tables_;
    const InterruptGuard* interrupt_ = nullptr; ///< of run(); tables are built there only
    World world_;
};

} // namespace toile
