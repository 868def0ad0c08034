#pragma once

#include <optional>
#include <vector>

#include "apps/toile/check/certificate.h"
#include "apps/toile/simulate/run_files.h"
#include "apps/toile/simulate/run_report.h"
#include "apps/toile/simulate/scene_job.h"
#include "apps/toile/terminal/interrupt.h"
#include "apps/toile/terminal/run_log.h"
#include "apps/toile/terminal/setup_progress.h"
#include "scenes/world/world.h"

namespace toile::app {

/// Settings shared by all scenes of a run.
struct RunSettings {
    scenes::Backend backend = scenes::Backend::Cpu;
    int device = 0; ///< number of the GPU, if one is used
    bool no_cache = false;
    bool no_check = false;
    const scenes::BaselineMethods* baselines =
        nullptr; ///< methods that scenes may select, borrowed; null: none
};

/// One scene of `toile simulate`, from its files to its caches, report and certificate. Used by one thread.
class SceneRun {
public:
    /// Loads, places and prepares everything.
    /// @param job        outlives the run
    /// @param interrupt  ends that; null: signals end the program, which has nothing to lose yet
    /// @throws Cancelled, and as World's constructor
    SceneRun(const SceneJob& job, const RunSettings& settings, RunLog log, const InterruptGuard* interrupt);

    /// Simulates, writes and checks.
    /// @return kExitOk; kExitFailure after reporting a failure, an interrupt, or a certificate that does not
    ///         hold
    /// @throws InvalidInput if a folder is locked or can't be written; nothing was written then
    int run(const InterruptGuard& interrupt);

    /// End of the frames.
    struct Outcome {
        std::string word = "complete"; ///< or "interrupted", "failed"
        std::string message;           ///< reason of a failure
    };

private:
    scenes::WorldOptions world_options(const RunSettings& settings);
    void tell(const std::string& task, double fraction);
    StepReport advance_frame(RunFiles& files);
    Outcome run_frames(RunFiles& files, RunReport& report);
    Outcome run_or_stop(RunFiles& files, RunReport& report);
    std::optional<Certificate> check(const RunFiles& files) const;
    int publish(RunFiles& files, const RunReport& report) const;

    const SceneJob& job_;
    bool no_check_;
    RunLog log_;
    SetupProgress progress_;
    const InterruptGuard* interrupt_;  ///< null: none
    std::unique_ptr<Progress> frames_; ///< null before the first frame and after the last
    std::chrono::steady_clock::time_point frame_start_;
    int subframes_;         ///< samples of the world per frame
    scenes::Scene sampled_; ///< the job's, with a frame for each sample
    scenes::World world_;
    std::vector<std::vector<int>> inverted_; ///< [frames] World::inverted_tets()
};

} // namespace toile::app
