#pragma once

#include "core/pd/energy/energy.h"

namespace toile::research::solvers {

/// A ball that pushes vertices out by a smooth pressure, so that a draping step has a unique minimiser as
/// reference for every method. Differs from the simulator's contact, whose set of pairs is updated within a
/// step.
///
///   W = sum_v area_v k f(d_v),   d_v = radius - |x_v - center|
///   f(d) = 0 outside,  d^3 / 6s up to the depth s,  d^2/2 - s d/2 + s^2/6 beyond: twice differentiable
///
/// H contains no part of it: the membrane's part is many times larger at the vertices' spacing.
class BallPenalty : public Energy {
public:
    struct Ball {
        Vec3 center;            ///< [m]
        double radius = 0.0;    ///< [m]
        double stiffness = 0.0; ///< k [N/m^3]: pressure per depth
        double softness = 0.0;  ///< s [m]: depth of the smooth onset of the pressure
    };

    /// @param areas  [vertices] [m^2]
    BallPenalty(const Ball& ball, std::vector<double> areas);

    std::string_view name() const override { return "benchmarks/ball"; }
    void add_hessian(Triplets&) const override {}
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;

private:
    Ball ball_;
    std::vector<double> areas_;
};

} // namespace toile::research::solvers
