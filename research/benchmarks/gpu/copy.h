#pragma once

#include "core/compute/cuda/runtime/device.h"
#include "core/compute/lanes.h"

namespace toile::research::gpu {

/// to = from, 16 bytes at a time.
struct CopyItems {
    View<const Floats<4>> from;
    View<Floats<4>> to;

    TOILE_HD void operator()(int i) const { to[i] = from[i]; }
};

void launch(const CudaSpace& space, const CopyItems& kernel);

} // namespace toile::research::gpu
