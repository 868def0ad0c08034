#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/repair/start_report.h"
#include "core/base/stages.h"
#include "core/pd/step/step_report.h"
#include "scenes/format/scene.h"

namespace toile {
struct CudaDevice;
} // namespace toile

namespace toile::app {

/// Report of a simulation, for `simulate --report`: settings, the repair of the start pose, every frame,
/// calls and seconds of every stage, peak memory. Stages that never ran are absent.
class RunReport {
public:
    /// @param device  GPU on which it ran; null: the CPU
    RunReport(const scenes::Scene& scene, int vertex_count, collision::StartReport start,
              const CudaDevice* device);

    void add_frame(int frame, const StepReport& report, double seconds)
    {
        frames_.push_back({frame, report, seconds});
    }

    /// The report as JSON.
    /// @param outcome  "complete", "interrupted" or "failed"
    std::string to_json(const std::string& outcome, const Stages& stages) const;

private:
    struct Frame {
        int index;
        StepReport report;
        double seconds;
    };

    const scenes::Scene& scene_;
    int vertex_count_;
    collision::StartReport start_;
    std::string backend_;
    std::optional<int> device_; ///< number of the GPU
    std::vector<Frame> frames_;
};

/// "converged", "iteration_limit", "yielded", "pinched", "stuck" or "non_finite".
const char* to_word(StepReport::Status status);

} // namespace toile::app
