#pragma once

#include <vector>

#include "core/pd/energy/active_set_energy.h"
#include "core/pd/newton/coarse_age.h"
#include "core/pd/newton/component_weights.h"
#include "core/pd/newton/direction_stop.h"
#include "core/pd/newton/newton_space.h"

namespace toile {

/// NewtonSpace on the CPU.
class HostNewton : public NewtonSpace {
public:
    /// Objective and fields of a step; borrowed.
    struct Problem {
        Objective* objective = nullptr;
        View<Vec3> x;                      ///< [vertices] the current point [m]
        View<const Vec3> start;            ///< [vertices] positions at t0 [m]
        View<const Vec3> v;                ///< [vertices] velocities at t0 [m/s]
        View<const Vec3> prediction;       ///< [vertices] [m]
        View<const double> inertia;        ///< [vertices] [N/m]
        View<const unsigned char> fixed;   ///< [vertices]
        double dt = 0.0;                   ///< [s]
        ActiveSetEnergy* active = nullptr; ///< contact; may be null
    };

    /// @param points, extent  [vertices] undeformed positions, for the clusters of the AffineSpace
    /// @param weights         of their errors
    HostNewton(std::vector<EmbeddedPoint> points, Extent extent, ComponentWeights weights)
        : solver_(std::move(points), extent), weights_(std::move(weights))
    {
    }

    /// Begins a step.
    void set_problem(const Problem& problem);

    double evaluate() override;
    double max_speed() override;
    Solution find_direction(bool is_first, double error) override;
    bool has_contact() override;
    double model(double length) override;
    Solution correct(double error) override;
    Trial try_step(double length) override;
    double try_rest(double limit) override;
    double try_local_global() override;
    void take() override;
    void retake(double length) override;
    void keep() override;
    void restore() override;
    bool has_moved() override;
    double driving_speed() override;
    bool are_fixed_moving() override;
    double gradient_norm() override;

private:
    Solution solve(View<const Vec3> gradient, double error);
    double speed(double weighted_square) const;

    Problem problem_;
    HessianSolver solver_;
    ComponentWeights weights_;
    DirectionStop stop_;
    CoarseAge coarse_age_{HessianSolver::kPriceOfCoarse};
    std::vector<Vec3> gradient_, direction_, trial_, trial_gradient_;
    std::vector<Vec3> before_, kept_; ///< the point before take(), and that of keep() [m]

    // Contact ahead, see NewtonSpace::model().
    double contact_here_ = 0.0;                  ///< [J] contact's energy at the current point
    std::vector<Vec3> base_, correction_;        ///< d, e [m]
    std::vector<Vec3> gradient_without_contact_; ///< at the current point [N]
    std::vector<Vec3> product_, contact_gradient_, model_gradient_; ///< K d, both at the end of d [N]
};

} // namespace toile
