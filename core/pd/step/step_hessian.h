#pragma once

#include <vector>

#include "core/pd/energy/active_set_energy.h"
#include "core/pd/energy/curvature.h"
#include "core/pd/energy/objective.h"

namespace toile {

/// Hessian of one step: inertia, the curvature of the energies, and the frozen terms of an
/// active set. Rows and columns of fixed vertices are the identity's.
class StepHessian : public Hessian {
public:
    /// @param inertia  [vertices] m/dt^2 [N/m]; borrowed, like the others
    StepHessian(Curvature& curvature, View<const double> inertia, View<const unsigned char> fixed);

    /// Sets the frozen terms to include; null: none are active.
    void set_active(const ActiveSetEnergy* active) { active_ = active; }

    void linearise(View<const Vec3> x, Definiteness definiteness) override;
    void multiply(View<const Vec3> p, View<Vec3> out) override;
    void multiply_without_active_set(View<const Vec3> p, View<Vec3> out) override;
    void update_active_set() override;
    View<const Mat3> diagonal_blocks() const override { return diagonal_; }
    SparseMatrix matrix() const override;
    HessianParts parts() const override;

private:
    Curvature& curvature_;
    View<const unsigned char> fixed_;
    const ActiveSetEnergy* active_ = nullptr;
    View<const double> inertia_; ///< [vertices] m/dt^2 [N/m]
    std::vector<Mat3> diagonal_;
    std::vector<Vec3> free_; ///< scratch: p, zero at fixed vertices
};

} // namespace toile
