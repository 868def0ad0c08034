#pragma once

#include <memory>
#include <vector>

#include "core/backend/cuda/readback.h"
#include "core/backend/types.h"
#include "core/linear/field.h"
#include "core/pd/active_set_energy.h"
#include "core/pd/step_projection.h"
#include "core/pd/step_report.h"

namespace toile {

/// Point masses that a method moves through time: what is asked of a Body, wherever it runs, and of every
/// method that it is compared with.
class PointMasses {
public:
    virtual ~PointMasses() = default;

    /// Prepares for steps of dt [s] with these vertices fixed, which step() otherwise does.
    virtual void prepare([[maybe_unused]] double dt, [[maybe_unused]] const std::vector<unsigned char>& fixed)
    {
    }

    /// Advances by dt [s]. Same bits for every thread count, except where an AutoSolver has changed its
    /// method.
    /// @param acceleration  [vertices] external acceleration of this step [m/s^2]
    /// @param fixed         [vertices] 1 where `targets` prescribes the position at the end of the step
    /// @param targets       [vertices] read where fixed [m]
    /// @param active        contact; may be null
    /// @param projection    constraint on the end of the step; may be null
    virtual StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                            View<const Vec3> targets, ActiveSetEnergy* active,
                            StepProjection* projection) = 0;

    // Of the vertices now, good until they change [m], [m/s].
    virtual View<const Vec3> positions() const = 0;
    virtual View<const Vec3> velocities() const = 0;
    virtual void set_positions(View<const Vec3> x) = 0;
    virtual void set_velocities(View<const Vec3> v) = 0;

    /// Begins to bring the positions [vertices] [m], as they are now, from the device that has them; null
    /// where the host has. They must not outlive that device's space.
    /// @throws DeviceError where the device refuses
    virtual std::shared_ptr<const Readback<Vec3>> read_back_positions() { return nullptr; }

    /// Largest velocity of a vertex now [m/s]; NaN where one is.
    virtual double max_speed() const { return max_norm(velocities()); }

    /// [vertices] [kg], positive
    virtual View<const double> masses() const = 0;
};

/// Point masses on the CPU.
class PointMassesOnHost : public PointMasses {
public:
    explicit PointMassesOnHost(std::vector<Vec3> positions)
        : x_(std::move(positions)), v_(x_.size(), Vec3::Zero()), x_t1_(x_.size())
    {
    }

    View<const Vec3> positions() const override { return x_; }
    View<const Vec3> velocities() const override { return v_; }
    void set_positions(View<const Vec3> x) override { x_.assign(x.begin(), x.end()); }
    void set_velocities(View<const Vec3> v) override { v_.assign(v.begin(), v.end()); }

protected:
    /// q* = x + dt v + dt^2 a; fixed vertices go to their targets.
    /// @param prediction  [vertices] out [m]
    void predict(double dt, View<const Vec3> acceleration, View<const unsigned char> fixed,
                 View<const Vec3> targets, View<Vec3> prediction) const;

    std::vector<Vec3> x_, v_; ///< [vertices] [m], [m/s]
    std::vector<Vec3> x_t1_;  ///< [vertices] end of the step in the making [m]
};

} // namespace toile
