#pragma once

#include <vector>

#include "core/pd/energy.h"
#include "garment/energy/springs_kernels.h"

namespace toile {

/// Springs of zero rest length from vertices to moving points: attachments that give.
///
///   W = sum_j k_j/2 |x_i(j) - target_j|^2                       [Bouaziz et al. 2014, sec. 4, positional
///   constraint]
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
    void add_constant_curvature(Triplets&) const override {} ///< springs are released
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;
    bool add_to(DeviceEnergies& energies, int first_vertex) override;

    /// Moves the far ends [springs] [m].
    void set_target(int spring, const Vec3& target) { springs_[spring].target = target; }

    /// Lets go of a vertex. H keeps the spring's share, which is still a valid bound.
    void release(int spring) { springs_[spring].stiffness = 0.0; }

    /// As they are now; stiffness 0 where released.
    const std::vector<PlacedSpring>& placed() const { return springs_; }

private:
    std::vector<PlacedSpring> springs_;
};

} // namespace toile
