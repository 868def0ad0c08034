#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/pd/step_report.h"
#include "garment/energy/bending.h"
#include "garment/energy/membrane.h"

namespace toile {

/// What a rival method simulates: the same cloth that a Body gets as energies.
struct ClothModel {
    std::shared_ptr<const RestShape> rest;
    std::vector<double> masses; ///< [vertices] [kg], positive
    Membrane::Settings stretch;
    Bending::Settings bending;
};

/// A whole simulation method by other people, to be measured against Body. It answers like Body, without
/// contact and without strain limits.
class Rival {
public:
    Rival(std::vector<Vec3> positions, ClothModel cloth)
        : cloth_(std::move(cloth)), x_(std::move(positions)), v_(x_.size(), Vec3::Zero())
    {
    }
    virtual ~Rival() = default;

    /// Advances by dt [s]. Same bits for every thread count.
    /// @param acceleration  [vertices] external acceleration of this step [m/s^2]
    /// @param fixed         [vertices] 1 where `targets` prescribes the position at the end of the step
    /// @param targets       [vertices] read where fixed [m]
    /// @return iterations, displacement and status; energy and gradient are left 0: evaluating them is no
    ///         part of these methods
    virtual StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                            View<const Vec3> targets) = 0;

    View<const Vec3> positions() const { return x_; }
    View<const Vec3> velocities() const { return v_; }
    void set_positions(View<const Vec3> x) { x_.assign(x.begin(), x.end()); }
    void set_velocities(View<const Vec3> v) { v_.assign(v.begin(), v.end()); }

protected:
    ClothModel cloth_;
    std::vector<Vec3> x_, v_;
};

} // namespace toile
