#include "core/compute/cuda/runtime/answers.h"

#include "core/compute/cuda/runtime/runtime.h"

namespace toile {

bool is_responding(int device)
{
    CUstream_st* const of_no_space = nullptr;
    return cuda::wait_for(device, of_no_space) == cuda::Status::Good;
}

} // namespace toile
