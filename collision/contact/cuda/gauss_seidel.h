#pragma once

#include "collision/contact/cuda/energy.h"
#include "core/compute/cuda/scan.h"
#include "core/compute/gauss_seidel.h"

namespace toile::collision {

/// CpuGaussSeidel on a GPU.
class DeviceGaussSeidel {
public:
    /// @param space  borrowed
    DeviceGaussSeidel(const CudaSpace& space, int vertex_count);

    /// Does as CpuGaussSeidel::sweep, but always enqueues all sweeps: one that finds no terms does nothing.
    /// Does not wait. Defined in gauss_seidel.cuh.
    template <typename Projection>
    void sweep(const DeviceContactEnergy& contact, const Projection& projection, int sweeps);

private:
    GaussSeidelState make_schedule(const DeviceContactEnergy& contact, int sweeps, int fields);

    const CudaSpace& space_;
    int vertex_count_;
    DeviceArray<unsigned char> flags_;  ///< [slots]
    DeviceArray<int> slots_, count_;    ///< see GaussSeidelState
    DeviceArray<GaussSeidelRank> rank_; ///< see GaussSeidelState
    DeviceArray<TaggedVector> passed_;  ///< [fields x vertices] see GaussSeidelState
    DeviceArray<unsigned> next_;        ///< [sweeps] see GaussSeidelState
    DeviceArray<float> deepest_;        ///< [sweeps x vertices] see FindDeepest; empty without kPropagates
    DeviceScratch scratch_;
};

} // namespace toile::collision
