#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "collision/untangle/start_report.h"
#include "core/backend/cuda/runtime.h"
#include "core/backend/stages.h"
#include "core/pd/step_report.h"
#include "scenes/format/scene.h"

namespace toile {

/// What a simulation did, for `simulate --report`: settings, the repair of the start pose, every frame, calls
/// and seconds of every stage, peak memory. Stages that never ran are absent.
class RunReport {
public:
    /// @param device  the GPU that it ran on; null: the CPU
    RunReport(const Scene& scene, int vertex_count, StartReport start, const CudaDevice* device)
        : scene_(scene), vertex_count_(vertex_count), start_(std::move(start)),
          backend_(device != nullptr ? "cuda: " + device->name : "cpu"),
          device_(device != nullptr ? std::optional(device->index) : std::nullopt)
    {
    }

    void add_frame(int frame, const StepReport& report, double seconds)
    {
        frames_.push_back({frame, report, seconds});
    }

    /// Writes JSON.
    /// @param outcome  "complete", "interrupted" or "failed"
    /// @throws InvalidInput or DeviceError as write_atomically().
    void write(const std::filesystem::path& file, const std::string& outcome, const Stages& stages) const;

private:
    struct Frame {
        int index;
        StepReport report;
        double seconds;
    };

    const Scene& scene_;
    int vertex_count_;
    StartReport start_;
    std::string backend_;
    std::optional<int> device_; ///< number of the GPU
    std::vector<Frame> frames_;
};

/// "converged", "iteration_limit" or "non_finite".
const char* to_word(StepReport::Status status);

} // namespace toile
