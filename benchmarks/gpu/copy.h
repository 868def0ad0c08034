#pragma once

#include "core/backend/cuda/device.h"
#include "core/backend/lanes.h"

namespace toile::gpu {

/// to = from, 16 bytes at a time.
struct CopyItems {
    View<const Floats<4>> from;
    View<Floats<4>> to;

    TOILE_HD void operator()(int i) const { to[i] = from[i]; }
};

void launch(const CudaSpace& space, const CopyItems& kernel);

} // namespace toile::gpu
