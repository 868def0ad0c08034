#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/backend/cuda/device.h"
#include "core/backend/types.h"

namespace toile {

/// Where a gradient is asked for, on a GPU.
struct DeviceEvaluation {
    View<const Vec3> x;  ///< [vertices] [m]
    View<Vec3> gradient; ///< [vertices] added to [N]
    View<double> energy; ///< [vertices] added to: shares of the value, whose sum counts [J]
};

/// Terms of one kind of all cloths of a body, on a GPU: what Energy is on the CPU.
class DeviceEnergy {
public:
    virtual ~DeviceEnergy() = default;

    /// Called before every step: takes what the host has changed since. Enqueued.
    virtual void begin_step() {}

    /// Enqueues adding value and gradient. What it launches is recorded once and repeated, so it may depend
    /// on arrays of the device only.
    virtual void add_gradient(const DeviceEvaluation& at) = 0;
};

/// The terms of a body. Every energy adds its part (Energy::add_to), and equal kinds become one set of
/// kernels.
class DeviceEnergies {
public:
    explicit DeviceEnergies(const CudaSpace& space) : space_(space) {}

    const CudaSpace& space() const { return space_; }

    /// The one of this kind, made when it is first asked for.
    template <typename Kind>
    Kind& of_kind()
    {
        for (const auto& energy : all_)
            if (auto* found = dynamic_cast<Kind*>(energy.get()))
                return *found;
        auto made = std::make_unique<Kind>(space_);
        Kind& kind = *made;
        all_.push_back(std::move(made));
        return kind;
    }

    const std::vector<std::unique_ptr<DeviceEnergy>>& all() const { return all_; }

private:
    const CudaSpace& space_;
    std::vector<std::unique_ptr<DeviceEnergy>> all_;
};

} // namespace toile
