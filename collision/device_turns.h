#pragma once

#include "collision/device_contact_energy.h"
#include "core/backend/cuda/scan.h"
#include "core/backend/turns.h"

namespace toile {

/// HostTurns on a GPU.
class DeviceTurns {
public:
    /// @param space  borrowed
    DeviceTurns(const CudaSpace& space, int vertex_count);

    /// As HostTurns, of all sweeps that are asked for: one that finds nothing does nothing. Does not wait. In
    /// device_turns.cuh.
    template <typename Push>
    void sweep(const DeviceContactEnergy& contact, const Push& push, int sweeps);

private:
    Turns make_room(const DeviceContactEnergy& contact, int sweeps, int fields);

    const CudaSpace& space_;
    int vertex_count_;
    DeviceArray<unsigned char> flags_; ///< [places]
    DeviceArray<int> places_, count_;  ///< see Turns
    DeviceArray<TurnRank> rank_;       ///< see Turns
    DeviceArray<TaggedVector> passed_; ///< [fields x vertices] see Turns
    DeviceArray<unsigned> next_;       ///< [sweeps] see Turns
    DeviceArray<float> deepest_;       ///< [sweeps x vertices] see FindDeepest; none where nothing is carried
    DeviceScratch scratch_;
};

} // namespace toile
