#pragma once

#include <string_view>

#include "core/compute/cuda/runtime/device.h"

namespace toile {

/// Kernels and copies recorded once and launched as one, for a few microseconds whatever their number. For
/// steps whose kernels are the same every time.
class CudaGraph {
public:
    /// Records nothing yet.
    /// @param name  a literal: stage of launch() and in errors
    CudaGraph(const CudaSpace& space, std::string_view name) : space_(&space), name_(name) {}
    ~CudaGraph();
    CudaGraph(const CudaGraph&) = delete;
    CudaGraph& operator=(const CudaGraph&) = delete;

    /// Records the work that work() gives to the space's stream, instead of running it; replaces the last
    /// recording. Costs an update if the shape is as before, else an instantiation (far dearer).
    ///
    /// Arguments are frozen: views must stay valid, so arrays may not grow afterwards without another
    /// recording. work() must not wait, read back or grow arrays. Its stages are counted now, not at
    /// launches.
    /// @throws DeviceError if something in work() can't be recorded, and what work() throws; the graph is
    ///         then as it was.
    template <typename Work>
    void record(const Work& work)
    {
        begin();
        try {
            work();
        } catch (...) {
            abandon();
            throw;
        }
        finish();
    }

    /// Runs the recording in stream order; does nothing if there is none. One call of stage `name`.
    void launch(CallSite where = CallSite::here());

    int node_count() const { return node_count_; } ///< kernels, copies and fills recorded
    int instantiations() const { return instantiations_; }
    int updates() const { return updates_; }

private:
    void begin();
    void abandon();
    void finish();
    void instantiate(CUgraph_st* graph);
    void forget();

    const CudaSpace* space_;
    std::string_view name_;
    CUgraphExec_st* program_ = nullptr;
    int node_count_ = 0;
    int instantiations_ = 0;
    int updates_ = 0;
};

} // namespace toile
