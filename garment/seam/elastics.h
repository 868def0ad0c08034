#pragma once

#include <vector>

#include "core/pd/energy/energy.h"

namespace toile::garment {

/// Elastics sewn to cloth: springs between pairs of vertices, which pull where they are longer than at rest
/// and do not push where they are shorter.
///
///   W = sum_j  k_j l_j / 2  max(0, |x_a - x_b| / l_j - 1)^2
///
/// Springs of one k in a row act as one of their whole length: its tension is k times its strain.
class Elastics : public Energy {
public:
    struct Spring {
        int a = 0, b = 0;         ///< vertices
        double rest_length = 0.0; ///< [m] l
        double stiffness = 0.0;   ///< [N] k, the tension per unit of strain
    };

    /// @throws InvalidInput for lengths or stiffnesses that are not positive
    explicit Elastics(std::vector<Spring> springs);

    std::string_view name() const override { return "garment/elastics"; }
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets&) const override {}
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override;
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;

    const std::vector<Spring>& springs() const { return springs_; }

private:
    std::vector<Spring> springs_;
};

} // namespace toile::garment
