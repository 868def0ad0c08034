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
    View<double> own;    ///< [share_count()] overwritten: more shares, of this energy alone [J]
};

/// Terms of one kind of all cloths of a body, on a GPU: what Energy is on the CPU.
class DeviceEnergy {
public:
    virtual ~DeviceEnergy() = default;

    /// Called before every step: takes what the host has changed since. Enqueued.
    /// @param x  [vertices] where the step starts [m], on the device
    virtual void begin_step([[maybe_unused]] View<const Vec3> x) {}

    /// Shares of the value that belong to no vertex.
    virtual int share_count() const { return 0; }

    /// Enqueues adding value and gradient. What it launches is recorded once and repeated, so it may depend
    /// on arrays of the device only.
    virtual void add_gradient(const DeviceEvaluation& at) = 0;

    /// Called once per step, for what an energy remembers of its minimiser. Enqueued.
    /// @param x  [vertices] the last minimiser [m], on the device, before contact and limits end the step
    virtual void end_minimisation([[maybe_unused]] View<const Vec3> x) {}
};

/// The terms of a body. Every energy adds its part (Energy::add_to), and equal kinds become one set of
/// kernels.
class DeviceEnergies {
public:
    explicit DeviceEnergies(const CudaSpace& space) : space_(space) {}

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

    /// Shares of the value that belong to no vertex, of all.
    int share_count() const
    {
        int count = 0;
        for (const auto& energy : all_)
            count += energy->share_count();
        return count;
    }

    /// Enqueues adding all of them.
    /// @param at  its `own` holds the shares of all
    void add_gradient(const DeviceEvaluation& at) const
    {
        int first = 0;
        for (const auto& energy : all_) {
            energy->add_gradient(
                {at.x, at.gradient, at.energy, at.own.subview(first, energy->share_count())});
            first += energy->share_count();
        }
    }

private:
    const CudaSpace& space_;
    std::vector<std::unique_ptr<DeviceEnergy>> all_;
};

} // namespace toile
