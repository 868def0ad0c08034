#pragma once

#include <memory>
#include <vector>

#include "core/compute/types.h"
#include "core/linear/field.h"
#include "core/pd/energy/active_set_energy.h"
#include "core/pd/step/step_projection.h"
#include "core/pd/step/step_report.h"

namespace toile {

template <typename T>
class Readback;

/// Point masses advanced in time: interface of Body on any device, and of the methods that it is compared
/// with.
class PointMasses {
public:
    virtual ~PointMasses() = default;

    /// Prepares for steps of dt [s] with these vertices fixed; otherwise step() does so.
    virtual void prepare([[maybe_unused]] double dt, [[maybe_unused]] const std::vector<unsigned char>& fixed)
    {
    }

    /// Advances by dt [s]. Same bits for every thread count, unless an AutoSolver changes its method.
    /// @param acceleration  [vertices] external acceleration of this step [m/s^2]
    /// @param fixed         [vertices] 1 if `targets` prescribes the position at the end of the step
    /// @param targets       [vertices] read where fixed [m]
    /// @param active        contact; may be null
    /// @param projection    constraint on the final positions; may be null
    virtual StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                            View<const Vec3> targets, ActiveSetEnergy* active,
                            StepProjection* projection) = 0;

    /// Sets the RMS local error [m] of the time integration beyond which step() leaves everything as it was,
    /// and says so (StepReport::refused). By default, and for methods without an estimate, no step is
    /// refused.
    void refuse_steps_beyond(double error) { max_error_ = error; }

    /// Declares parts through which sound passes within a step: an impact is one of all their vertices.
    /// Without effect on methods that integrate by themselves.
    /// @param of_vertex  [vertices] number of its part, from 0 on; -1: of none
    virtual void set_stiff_parts([[maybe_unused]] const std::vector<int>& of_vertex) {}

    /// Forgets earlier steps and what touched: the next step is the first of the motion.
    virtual void begin_anew() {}

    // Current positions [m] and velocities [m/s] of the vertices; views are valid until the next change.
    virtual View<const Vec3> positions() const = 0;
    virtual View<const Vec3> velocities() const = 0;
    virtual void set_positions(View<const Vec3> x) = 0;
    virtual void set_velocities(View<const Vec3> v) = 0;

    /// Begins to copy the current positions [vertices] [m] from the device; null if the host has them. The
    /// readback must not outlive the device's space.
    /// @throws DeviceError if the device refuses
    virtual std::shared_ptr<const Readback<Vec3>> read_back_positions() { return nullptr; }

    /// Largest current speed of a vertex [m/s]; NaN if any is NaN.
    virtual double max_speed() const { return max_norm(velocities()); }

    /// [vertices] [kg], positive
    virtual View<const double> masses() const = 0;

protected:
    double max_error_ = kAnyStepError; ///< see refuse_steps_beyond()
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
    /// Computes q* = x + dt v + dt^2 a; fixed vertices move to their targets.
    /// @param prediction  [vertices] out [m]
    void predict(double dt, View<const Vec3> acceleration, View<const unsigned char> fixed,
                 View<const Vec3> targets, View<Vec3> prediction) const;

    /// Moves x_t1_ onto the constraint. The displacement becomes velocity, like that of any force.
    /// @param masses, fixed   [vertices] [kg], 1 if the position is prescribed
    /// @param clear_contacts  see StepProjection::project
    void project(StepProjection& projection, double dt, View<const double> masses,
                 View<const unsigned char> fixed, const std::function<bool()>& clear_contacts);

    std::vector<Vec3> x_, v_; ///< [vertices] [m], [m/s]
    std::vector<Vec3> x_t1_;  ///< [vertices] tentative positions at the end of the step [m]

private:
    std::vector<double> inverse_masses_; ///< [vertices] [1/kg] 0 where fixed
    std::vector<Vec3> unprojected_;      ///< [vertices] [m]
};

} // namespace toile
