#pragma once

#include <vector>

#include "core/backend/cuda/array.h"
#include "core/pd/device/device_energy.h"
#include "garment/energy/springs.h"

namespace toile {

/// Springs of all cloths of a body on a GPU. Targets and released springs are taken from the host before
/// every step.
class DeviceSprings : public DeviceEnergy {
public:
    explicit DeviceSprings(const CudaSpace& space);

    /// Adds the springs of a cloth: all of them before the first step.
    /// @param springs       borrowed
    /// @param first_vertex  of the cloth among the body's
    void add(const Springs& springs, int first_vertex);

    void begin_step(View<const Vec3> x) override;
    void add_gradient(const DeviceEvaluation& at) override;

private:
    struct Part {
        const Springs* springs;
        int first_vertex;
    };

    void take_springs();

    const CudaSpace& space_;
    std::vector<Part> parts_;
    std::vector<PlacedSpring> host_; ///< ascending by vertex
    std::vector<int> order_;         ///< places in host_ of the springs, part after part
    DeviceArray<PlacedSpring> placed_;
    DeviceArray<int> first_; ///< [held vertices + 1] into placed_
};

} // namespace toile
