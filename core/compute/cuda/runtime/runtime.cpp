#include "core/compute/cuda/runtime/runtime.h"

#include <cstdlib>

#include <cuda_runtime_api.h>

namespace toile::cuda {

namespace {

Status status_of(cudaError_t error) { return Status(int(error)); }

/// Status of a call. Clears CUDA's record of a failure, which would otherwise count against the next launch.
Status answer(cudaError_t error)
{
    if (error != cudaSuccess)
        cudaGetLastError();
    return status_of(error);
}

/// Runs call() on a device.
template <typename Call>
Status on_device(int device, const Call& call)
{
    const cudaError_t error = cudaSetDevice(device);
    return answer(error == cudaSuccess ? call() : error);
}

/// "13.0" of CUDA's 13000.
std::string version(int number)
{
    return std::to_string(number / 1000) + "." + std::to_string(number % 1000 / 10);
}

std::string why_no_device(cudaError_t error)
{
    int driver = 0, runtime = 0;
    cudaDriverGetVersion(&driver);
    cudaRuntimeGetVersion(&runtime);
    if (driver == 0)
        return "no driver is installed";
    if (error == cudaErrorInsufficientDriver)
        return "the driver knows CUDA " + version(driver) + ", this build needs " + version(runtime);
    if (error == cudaSuccess || error == cudaErrorNoDevice)
        return "the driver finds no device";
    return reason_of(status_of(error));
}

cudaError_t describe(int index, CudaDevice& device)
{
    cudaDeviceProp found;
    const cudaError_t error = cudaGetDeviceProperties(&found, index);
    if (error == cudaSuccess)
        device = {index,       found.name, found.totalGlobalMem, found.multiProcessorCount,
                  found.major, found.minor};
    return error;
}

} // namespace

std::string reason_of(Status status) { return cudaGetErrorString(cudaError_t(int(status))); }

FoundDevices find_devices()
{
    FoundDevices found;
    int count = 0;
    cudaError_t error = cudaGetDeviceCount(&count);
    for (int i = 0; error == cudaSuccess && i < count; ++i)
        error = describe(i, found.devices.emplace_back());
    if (error != cudaSuccess) {
        cudaGetLastError();
        found.devices.clear();
    }
    if (found.devices.empty())
        found.why_none = why_no_device(error);
    return found;
}

void load_kernels_eagerly() { setenv("CUDA_MODULE_LOADING", "EAGER", 0); }

Status use_device(int device) { return answer(cudaSetDevice(device)); }

Status open_stream(int device, CUstream_st*& stream)
{
    // Non-blocking: no hidden order with the default stream of other libraries.
    return on_device(device, [&] { return cudaStreamCreateWithFlags(&stream, cudaStreamNonBlocking); });
}

Status close_stream(int device, CUstream_st* stream)
{
    return on_device(device, [&] { return cudaStreamDestroy(stream); });
}

Status wait_for(int device, CUstream_st* stream)
{
    return on_device(device, [&] { return cudaStreamSynchronize(stream); });
}

Status query_stream(int device, CUstream_st* stream)
{
    return on_device(device, [&] { return cudaStreamQuery(stream); });
}

bool is_busy(Status status) { return status == status_of(cudaErrorNotReady); }

Status take_launch_error() { return status_of(cudaGetLastError()); }

Status allocate(int device, std::size_t bytes, void*& data)
{
    return on_device(device, [&] { return cudaMalloc(&data, bytes); });
}

Status release(int device, void* data)
{
    return on_device(device, [&] { return cudaFree(data); });
}

Status allocate_pinned(int device, std::size_t bytes, void*& data)
{
    return on_device(device, [&] { return cudaMallocHost(&data, bytes); });
}

Status release_pinned(int device, void* data)
{
    return on_device(device, [&] { return cudaFreeHost(data); });
}

bool is_out_of_memory(Status status)
{
    return status == status_of(cudaErrorMemoryAllocation) || status == status_of(cudaErrorInvalidValue);
}

Status memory_left(int device, std::size_t& free, std::size_t& total)
{
    return on_device(device, [&] { return cudaMemGetInfo(&free, &total); });
}

Status copy(int device, CUstream_st* stream, Direction direction, void* to, const void* from,
            std::size_t bytes)
{
    const cudaMemcpyKind kind = direction == Direction::HostToDevice   ? cudaMemcpyHostToDevice
                                : direction == Direction::DeviceToHost ? cudaMemcpyDeviceToHost
                                                                       : cudaMemcpyDeviceToDevice;
    return on_device(device, [&] { return cudaMemcpyAsync(to, from, bytes, kind, stream); });
}

Status fill(int device, CUstream_st* stream, void* data, unsigned char byte, std::size_t bytes)
{
    return on_device(device, [&] { return cudaMemsetAsync(data, byte, bytes, stream); });
}

bool is_recording(CUstream_st* stream)
{
    cudaStreamCaptureStatus state = cudaStreamCaptureStatusNone;
    return answer(cudaStreamIsCapturing(stream, &state)) == Status::Good &&
           state != cudaStreamCaptureStatusNone;
}

Status begin_recording(int device, CUstream_st* stream)
{
    // Thread-local: calls that no recording allows fail on this thread only; other threads are not affected.
    return on_device(device,
                     [&] { return cudaStreamBeginCapture(stream, cudaStreamCaptureModeThreadLocal); });
}

Status end_recording(int device, CUstream_st* stream, CUgraph_st*& graph)
{
    return on_device(device, [&] { return cudaStreamEndCapture(stream, &graph); });
}

Status instantiate(int device, CUgraph_st* graph, CUgraphExec_st*& program)
{
    return on_device(device, [&] { return cudaGraphInstantiate(&program, graph, 0); });
}

Status update(int device, CUgraphExec_st* program, CUgraph_st* graph)
{
    cudaGraphExecUpdateResultInfo result;
    return on_device(device, [&] { return cudaGraphExecUpdate(program, graph, &result); });
}

Status launch(int device, CUgraphExec_st* program, CUstream_st* stream)
{
    return on_device(device, [&] { return cudaGraphLaunch(program, stream); });
}

Status node_count(CUgraph_st* graph, int& count)
{
    std::size_t nodes = 0;
    const cudaError_t error = cudaGraphGetNodes(graph, nullptr, &nodes);
    count = int(nodes);
    return answer(error);
}

Status destroy(CUgraph_st* graph) { return answer(cudaGraphDestroy(graph)); }
Status destroy(CUgraphExec_st* program) { return answer(cudaGraphExecDestroy(program)); }

Status make_event(int device, EventUse use, CUevent_st*& event)
{
    const unsigned flags =
        use == EventUse::Timing ? cudaEventDefault : cudaEventDisableTiming | cudaEventBlockingSync;
    return on_device(device, [&] { return cudaEventCreateWithFlags(&event, flags); });
}

Status destroy(CUevent_st* event) { return answer(cudaEventDestroy(event)); }

Status record(int device, CUevent_st* event, CUstream_st* stream)
{
    return on_device(device, [&] { return cudaEventRecord(event, stream); });
}

Status wait_for(int device, CUevent_st* event)
{
    return on_device(device, [&] { return cudaEventSynchronize(event); });
}

Status delay(int device, CUstream_st* stream, CUevent_st* event)
{
    return on_device(device, [&] { return cudaStreamWaitEvent(stream, event); });
}

Status elapsed_ms(CUevent_st* from, CUevent_st* to, float& ms)
{
    return answer(cudaEventElapsedTime(&ms, from, to));
}

} // namespace toile::cuda
