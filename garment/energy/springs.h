#pragma once

#include <vector>

#include "core/pd/energy/energy.h"
#include "garment/energy/springs_kernels.h"

namespace toile::garment {

/// Springs of zero rest length from vertices to moving points: compliant attachments.
///
///   W = sum_j k_j/2 |x_i(j) - target_j|^2          [Bouaziz et al. 2014, sec. 4, positional constraint]
class Springs : public Energy {
public:
    struct Spring {
        int vertex = 0;
        double stiffness = 0.0; ///< [N/m] k; positive
    };

    explicit Springs(const std::vector<Spring>& springs);

    std::string_view name() const override { return "garment/springs"; }
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets&) const override {} ///< springs may be released
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;
    bool add_to(DeviceEnergies& energies, int first_vertex) override;

    /// Holds a vertex at a target [m].
    void hold(int spring, const Vec3& target)
    {
        springs_[spring].target = target;
        springs_[spring].stiffness = stiffness_[spring];
    }

    /// Releases a vertex. H keeps the spring's contribution, which is still a valid bound.
    void release(int spring) { springs_[spring].stiffness = 0.0; }

    /// Current springs [springs]; stiffness 0 if released.
    const std::vector<AnchorSpring>& anchors() const { return springs_; }

private:
    std::vector<AnchorSpring> springs_;
    std::vector<double> stiffness_; ///< [springs] of those that hold [N/m]
};

} // namespace toile::garment
