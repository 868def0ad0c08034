#pragma once

#include <string_view>

#include "core/backend/cuda/device.h"

namespace toile {

/// Kernels and copies recorded once and launched as one, which costs a few microseconds however many they
/// are. A step whose kernels are the same every time belongs into one.
class CudaGraph {
public:
    /// Holds nothing yet.
    /// @param name  a literal: stage of launch() and in errors
    CudaGraph(const CudaSpace& space, std::string_view name) : space_(&space), name_(name) {}
    ~CudaGraph();
    CudaGraph(const CudaGraph&) = delete;
    CudaGraph& operator=(const CudaGraph&) = delete;

    /// Records what work() gives the space's stream, instead of running it; replaces what was recorded.
    /// Arguments are frozen: views must stay valid, so arrays may not grow afterwards without recording anew.
    /// work() must not wait, read back or grow arrays. Stages that it enters are counted now, not at
    /// launches. Costs an update where the shape is as before, an instantiation (far dearer) where it is not.
    /// @throws DeviceError when something in work() can't be recorded, and what work() throws; the graph is
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

    /// Runs what was recorded, in the stream's turn; nothing where nothing was. One call of stage `name`.
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
