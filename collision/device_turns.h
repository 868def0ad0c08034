#pragma once

#include "collision/contact_kernels.h"
#include "collision/contact_pushes.h"
#include "core/backend/cuda/roomy.h"
#include "core/backend/cuda/scan.h"

namespace toile {

/// HostTurns on a GPU.
class DeviceTurns {
public:
    /// @param space  borrowed
    DeviceTurns(const CudaSpace& space, int vertex_count);

    /// Lists the terms nearer than the margin [m]. Does not wait.
    /// @param touches   all terms, by vertex; on the device, borrowed as x until outcome()
    /// @param vertices  [lists] of touches
    /// @param x         [vertices] [m]
    void list(const ContactTouches& touches, View<const int> vertices, View<Vec3> x, double margin);

    /// Lets those push, as HostTurns. Does not wait. In device_turns.cuh.
    template <typename Push>
    void run(const Push& push, int sweeps, double margin = HUGE_VAL);

    /// Waits for what became of it.
    PushOutcome outcome();

private:
    const CudaSpace& space_;
    ContactTouches touches_;
    View<const int> vertices_; ///< [lists]
    View<Vec3> x_;
    Turns turns_;
    DeviceArray<unsigned char> flags_;       ///< [places]
    DeviceArray<int> places_, count_, rank_; ///< see Turns
    DeviceArray<int> total_, served_;        ///< [vertices] see Turns
    DeviceArray<unsigned> next_;             ///< [1] see Turns
    DeviceArray<Vec3> start_;                ///< [vertices] those of touched ones
    DeviceArray<PushOutcome> outcome_;       ///< [1]
    PinnedArray<PushOutcome> outcome_here_;
    DeviceScratch scratch_;
};

} // namespace toile
