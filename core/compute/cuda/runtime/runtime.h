#pragma once

/// All calls of the CUDA runtime that core/compute/cuda makes. runtime.cpp makes them; no_runtime.cpp
/// replaces it in a build without CUDA and refuses each. Code outside of core/compute/cuda uses device.h,
/// array.h, graph.h, timer.h and parallel.cuh instead.

#include <cstddef>
#include <string>
#include <vector>

// CUDA's own types behind cudaStream_t, cudaEvent_t, cudaGraph_t and cudaGraphExec_t.
struct CUstream_st;
struct CUevent_st;
struct CUgraph_st;
struct CUgraphExec_st;

namespace toile {

/// One GPU as the driver lists it.
struct CudaDevice {
    int index = -1;
    std::string name;
    std::size_t memory = 0; ///< [bytes] all of it
    int multiprocessors = 0;
    int capability_major = 0, capability_minor = 0; ///< "compute capability" 9.0 is Hopper
};

namespace cuda {

/// Result of a call: 0 is good, other numbers are CUDA's own (cudaError_t), -1 a build without CUDA.
enum class Status : int { Good = 0, NotBuilt = -1 };

/// Text of a status in CUDA's words.
std::string reason_of(Status status);

struct FoundDevices {
    std::vector<CudaDevice> devices;
    std::string why_none; ///< empty if there is a device
};
FoundDevices find_devices();

/// Makes kernels load when a device is opened, not one by one in the steps that launch them first. Call it at
/// the start of a program, before any other thread or call. A CUDA_MODULE_LOADING that is set already
/// decides.
void load_kernels_eagerly();

/// Makes a device that of this thread; every call below that takes a device does so.
Status use_device(int device);
Status open_stream(int device, CUstream_st*& stream);
Status close_stream(int device, CUstream_st* stream);
Status wait_for(int device, CUstream_st* stream);
/// Good if the stream has done all its work.
Status query_stream(int device, CUstream_st* stream);
bool is_busy(Status status);

/// Returns and clears the error of this thread's latest launch.
Status take_launch_error();

Status allocate(int device, std::size_t bytes, void*& data);
Status release(int device, void* data);
Status allocate_pinned(int device, std::size_t bytes, void*& data);
Status release_pinned(int device, void* data);
bool is_out_of_memory(Status status);
Status memory_left(int device, std::size_t& free, std::size_t& total);

enum class Direction { HostToDevice, DeviceToHost, DeviceToDevice };
Status copy(int device, CUstream_st* stream, Direction direction, void* to, const void* from,
            std::size_t bytes);
Status fill(int device, CUstream_st* stream, void* data, unsigned char byte, std::size_t bytes);

/// Recording: work given to a stream is not run but kept as a graph.
bool is_recording(CUstream_st* stream);
Status begin_recording(int device, CUstream_st* stream);
Status end_recording(int device, CUstream_st* stream, CUgraph_st*& graph);
Status instantiate(int device, CUgraph_st* graph, CUgraphExec_st*& program);
/// Gives a program the graph's arguments. Not good if the shape differs: the program is then unusable.
Status update(int device, CUgraphExec_st* program, CUgraph_st* graph);
Status launch(int device, CUgraphExec_st* program, CUstream_st* stream);
Status node_count(CUgraph_st* graph, int& count);
Status destroy(CUgraph_st* graph);
Status destroy(CUgraphExec_st* program);

/// Use of an event: to measure times, or to block threads that leave their core meanwhile.
enum class EventUse { Timing, Waiting };
Status make_event(int device, EventUse use, CUevent_st*& event);
Status destroy(CUevent_st* event);
Status record(int device, CUevent_st* event, CUstream_st* stream);
Status wait_for(int device, CUevent_st* event);
/// Delays all later work of the stream until the event.
Status delay(int device, CUstream_st* stream, CUevent_st* event);
Status elapsed_ms(CUevent_st* from, CUevent_st* to, float& ms);

} // namespace cuda
} // namespace toile
