#include "core/compute/cuda/runtime/runtime.h"

// Only find_devices(), load_kernels_eagerly() and reason_of() are ever called: CudaSpace, which all else
// needs, can't be constructed.

namespace toile::cuda {

namespace {
constexpr const char* kReason = "this build is without CUDA";
}

std::string reason_of(Status) { return kReason; }
FoundDevices find_devices() { return {{}, kReason}; }
void load_kernels_eagerly() {}

Status use_device(int) { return Status::NotBuilt; }
Status open_stream(int, CUstream_st*&) { return Status::NotBuilt; }
Status close_stream(int, CUstream_st*) { return Status::NotBuilt; }
Status wait_for(int, CUstream_st*) { return Status::NotBuilt; }
Status query_stream(int, CUstream_st*) { return Status::NotBuilt; }
bool is_busy(Status) { return false; }
Status take_launch_error() { return Status::NotBuilt; }

Status allocate(int, std::size_t, void*&) { return Status::NotBuilt; }
Status release(int, void*) { return Status::NotBuilt; }
Status allocate_pinned(int, std::size_t, void*&) { return Status::NotBuilt; }
Status release_pinned(int, void*) { return Status::NotBuilt; }
bool is_out_of_memory(Status) { return false; }
Status memory_left(int, std::size_t&, std::size_t&) { return Status::NotBuilt; }
Status copy(int, CUstream_st*, Direction, void*, const void*, std::size_t) { return Status::NotBuilt; }
Status fill(int, CUstream_st*, void*, unsigned char, std::size_t) { return Status::NotBuilt; }

bool is_recording(CUstream_st*) { return false; }
Status begin_recording(int, CUstream_st*) { return Status::NotBuilt; }
Status end_recording(int, CUstream_st*, CUgraph_st*&) { return Status::NotBuilt; }
Status instantiate(int, CUgraph_st*, CUgraphExec_st*&) { return Status::NotBuilt; }
Status update(int, CUgraphExec_st*, CUgraph_st*) { return Status::NotBuilt; }
Status launch(int, CUgraphExec_st*, CUstream_st*) { return Status::NotBuilt; }
Status node_count(CUgraph_st*, int&) { return Status::NotBuilt; }
Status destroy(CUgraph_st*) { return Status::NotBuilt; }
Status destroy(CUgraphExec_st*) { return Status::NotBuilt; }

Status make_event(int, EventUse, CUevent_st*&) { return Status::NotBuilt; }
Status destroy(CUevent_st*) { return Status::NotBuilt; }
Status record(int, CUevent_st*, CUstream_st*) { return Status::NotBuilt; }
Status wait_for(int, CUevent_st*) { return Status::NotBuilt; }
Status delay(int, CUstream_st*, CUevent_st*) { return Status::NotBuilt; }
Status elapsed_ms(CUevent_st*, CUevent_st*, float&) { return Status::NotBuilt; }

} // namespace toile::cuda
