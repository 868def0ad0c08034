#include "core/compute/cuda/runtime/graph.h"

#include "core/base/error.h"
#include "core/base/stages.h"

namespace toile {

using cuda::Status;

CudaGraph::~CudaGraph() { forget(); }

void CudaGraph::begin()
{
    if (space_->is_recording())
        throw DeviceError("graph '" + std::string(name_) + "' can't be recorded while another is on " +
                          space_->described());
    space_->require(cuda::begin_recording(space_->device().index, space_->stream()), "recording graph",
                    name_);
}

void CudaGraph::abandon()
{
    // The recording may be broken already; all that matters is that it ends.
    CUgraph_st* graph = nullptr;
    static_cast<void>(cuda::end_recording(space_->device().index, space_->stream(), graph));
    if (graph != nullptr)
        static_cast<void>(cuda::destroy(graph));
}

void CudaGraph::finish()
{
    CUgraph_st* graph = nullptr;
    space_->require(cuda::end_recording(space_->device().index, space_->stream(), graph), "recording graph",
                    name_);
    try {
        if (program_ != nullptr && cuda::update(space_->device().index, program_, graph) == Status::Good)
            ++updates_;
        else
            instantiate(graph);
        space_->require(cuda::node_count(graph, node_count_), "counting the nodes of a graph");
    } catch (...) {
        static_cast<void>(cuda::destroy(graph));
        throw;
    }
    space_->require(cuda::destroy(graph), "forgetting the recording of a graph");
}

void CudaGraph::instantiate(CUgraph_st* graph)
{
    forget();
    space_->require(cuda::instantiate(space_->device().index, graph, program_), "instantiating graph", name_);
    ++instantiations_;
}

void CudaGraph::forget()
{
    if (program_ == nullptr)
        return;
    // Launches of the graph may be in flight.
    static_cast<void>(cuda::wait_for(space_->device().index, space_->stream()));
    static_cast<void>(cuda::destroy(program_));
    program_ = nullptr;
}

void CudaGraph::launch(CallSite where)
{
    const StageScope stage(name_);
    if (program_ == nullptr)
        return;
    space_->require(cuda::launch(space_->device().index, program_, space_->stream()), "launching graph",
                    name_);
    space_->launched(name_, where);
}

} // namespace toile
