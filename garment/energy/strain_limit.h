#pragma once

#include <memory>
#include <vector>

#include "core/pd/body.h"
#include "garment/energy/rest_shape.h"

namespace toile {

/// Hard limit on the principal stretches of every triangle.
///
///   sigma_max(F_t) <= 1 + limit   for all t
///
/// Enforced after the step's minimisation by nonlinear Gauss-Seidel over the violating triangles and their
/// neighbours: each is moved, mass-weighted, to the closest edges with clamped singular values
/// [Wang et al. 2010; Goldenthal et al. 2007 for projecting after the step]. In H the limit would need
/// weights that stall every method built on a fixed H (docs/garment/strain_limit.md).
class StrainLimit : public StepProjection {
public:
    struct Settings {
        double limit = 0.06;     ///< [-] largest principal stretch minus one. Must be positive.
        double tolerance = 1e-3; ///< [-] excess over the limit that is left alone
        int max_sweeps = 60;
    };

    /// @throws InvalidInput naming `source` when the limit is not positive.
    StrainLimit(std::shared_ptr<const RestShape> rest, const Settings& settings, const std::string& source);

    void project(View<Vec3> x, View<const double> inverse_masses, const ActiveSetEnergy* active) override;

    /// Largest principal stretch minus one at x [-].
    double max_strain(View<const Vec3> x) const;

private:
    bool clamp_triangle(int t, View<Vec3> x, View<const double> inverse_masses) const;
    std::vector<int> violating(View<const Vec3> x) const;

    std::shared_ptr<const RestShape> rest_;
    Settings settings_;
    std::vector<Mat2> rest_inv_;
};

} // namespace toile
