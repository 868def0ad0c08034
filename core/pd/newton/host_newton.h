#pragma once

#include <vector>

#include "core/pd/newton/hessian_solver.h"
#include "core/pd/newton/newton_space.h"

namespace toile {

/// NewtonSpace on the CPU.
class HostNewton : public NewtonSpace {
public:
    /// Objective and fields of a step; borrowed.
    struct Problem {
        Objective* objective = nullptr;
        View<Vec3> x;                    ///< [vertices] the current point [m]
        View<const Vec3> start;          ///< [vertices] positions at t0 [m]
        View<const Vec3> v;              ///< [vertices] velocities at t0 [m/s]
        View<const Vec3> prediction;     ///< [vertices] [m]
        View<const double> inertia;      ///< [vertices] [N/m]
        View<const double> masses;       ///< [vertices] [kg]
        View<const unsigned char> fixed; ///< [vertices]
        double dt = 0.0;                 ///< [s]
    };

    /// @param points  [vertices] undeformed positions, for the clusters of the AffineSpace
    explicit HostNewton(std::vector<EmbeddedPoint> points) : solver_(std::move(points)) {}

    /// Begins a step.
    void set_problem(const Problem& problem);

    double evaluate() override;
    double max_speed() override;
    Direction find_direction(bool is_first, double increment) override;
    Trial try_step(double length) override;
    double try_rest(double limit) override;
    double try_local_global() override;
    void take() override;
    bool has_moved() override;
    double driving_speed() override;
    bool are_fixed_moving() override;
    double gradient_norm() override;

private:
    Problem problem_;
    HessianSolver solver_;
    std::vector<Vec3> gradient_, direction_, trial_, trial_gradient_;
};

} // namespace toile
