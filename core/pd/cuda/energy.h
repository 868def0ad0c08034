#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/compute/cuda/runtime/device.h"
#include "core/compute/types.h"
#include "core/pd/cuda/newton/hessian_entries.h"

namespace toile {

/// Point of a gradient evaluation on a GPU, and its outputs.
struct DeviceEvaluation {
    View<const Vec3> x;    ///< [vertices] [m]
    View<Vec3> gradient;   ///< [vertices] added to [N]
    View<double> energy;   ///< [vertices] added to: parts of the value, whose sum counts [J]
    View<double> partials; ///< [partial_count()] overwritten: more parts, of this energy alone [J]
};

class HessianPattern;

/// Terms of one kind for all cloths of a body, on a GPU: counterpart of Energy.
class DeviceEnergy {
public:
    virtual ~DeviceEnergy() = default;

    /// Called before every step: takes over changes made on the host. Enqueued.
    /// @param x   [vertices] start of the step [m], on the device
    /// @param dt  [s]
    virtual void begin_step([[maybe_unused]] View<const Vec3> x, [[maybe_unused]] double dt) {}

    /// Number of parts of the value that belong to no vertex.
    virtual int partial_count() const { return 0; }

    /// Enqueues adding value and gradient. The launches are recorded once and repeated, so they may depend
    /// only on arrays of the device.
    virtual void add_gradient(const DeviceEvaluation& at) = 0;

    /// Learns where its entries of the Hessian are, for Newton's method. Called once, when all cloths are
    /// added.
    virtual void find_entries([[maybe_unused]] const HessianPattern& pattern) {}

    /// Enqueues adding the second derivative, projected to be positive semi-definite. Its constant part is
    /// there already.
    virtual void add_curvature([[maybe_unused]] const DeviceCurvature& at) {}

    /// Called once per step, for energies with a state that depends on the minimiser. Enqueued.
    /// @param x  [vertices] the last minimiser [m], on the device, before contact and limits change it
    virtual void end_minimisation([[maybe_unused]] View<const Vec3> x) {}
};

/// Terms of a body. Every energy adds its part (Energy::add_to); equal kinds share one set of kernels.
class DeviceEnergies {
public:
    explicit DeviceEnergies(const CudaSpace& space) : space_(space) {}

    /// Terms of this kind, created at the first call.
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

    /// Number of parts of the value that belong to no vertex, for all kinds.
    int partial_count() const
    {
        int count = 0;
        for (const auto& energy : all_)
            count += energy->partial_count();
        return count;
    }

    /// Enqueues adding all kinds.
    /// @param at  its `partials` holds the parts of all kinds
    void add_gradient(const DeviceEvaluation& at) const
    {
        int first = 0;
        for (const auto& energy : all_) {
            energy->add_gradient(
                {at.x, at.gradient, at.energy, at.partials.subview(first, energy->partial_count())});
            first += energy->partial_count();
        }
    }

private:
    const CudaSpace& space_;
    std::vector<std::unique_ptr<DeviceEnergy>> all_;
};

} // namespace toile
