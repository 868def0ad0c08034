#pragma once

#include "core/linear/cuda/solver.h"
#include "core/pd/cuda/body_kernels.h"
#include "core/pd/cuda/newton/newton_kernels.h"
#include "core/pd/cuda/newton/solver.h"
#include "core/pd/energy/active_set_energy.h"
#include "core/pd/newton/coarse_age.h"
#include "core/pd/newton/component_weights.h"
#include "core/pd/newton/direction_stop.h"

namespace toile {

/// NewtonSpace on a GPU.
class DeviceNewton : public NewtonSpace {
public:
    /// Fields of a step, on the device; borrowed.
    struct Problem {
        StepField x{View<Vec3>()};         ///< [vertices] the current point [m]
        View<const Vec3> start, v;         ///< [vertices] at t0 [m], [m/s]
        View<const Vec3> prediction;       ///< [vertices] [m]
        View<const double> inertia;        ///< [vertices] [N/m]
        View<const unsigned char> fixed;   ///< [vertices]
        double dt = 0.0;                   ///< [s]
        ActiveSetEnergy* active = nullptr; ///< may be null
    };

    /// @param space, energies, global_solver  borrowed
    /// @param points  [vertices] undeformed positions
    /// @param masses  [vertices] [kg]
    /// @param blocks, isotropic  pattern of the Hessian, see HessianPattern
    /// @param extent  of the points
    DeviceNewton(const CudaSpace& space, View<const EmbeddedPoint> points, View<const double> masses,
                 const BlockMatrix& blocks, const SparseMatrix& isotropic, Extent extent,
                 DeviceEnergies& energies, DeviceSolver& global_solver);

    /// Takes other fixed vertices.
    void set_fixed(const std::vector<unsigned char>& fixed);

    /// Begins a step.
    void set_problem(const Problem& problem);

    View<const Vec3> gradient() const { return gradient_.view(); } ///< at the current point [N]

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
    bool are_fixed_moving() override { return start_.moving > 0.0; }
    double gradient_norm() override { return 0.0; } ///< the body measures it with the end of the step

private:
    BeginNewtonTrial begin_trial();
    NewtonTrialSums measure();
    DeviceActiveSet* active();
    void freeze_here();
    void evaluate_contact(View<const Vec3> x);
    Solution solve(View<const Vec3> gradient, double error);
    double speed(double weighted_square) const;

    const CudaSpace& space_;
    DeviceEnergies& energies_;
    DeviceSolver& global_solver_;
    DeviceHessianSolver solver_;
    ComponentWeights weights_;
    DeviceArray<double> device_weights_; ///< [vertices] those of weights_
    Problem problem_;
    NewtonStartSums start_;       ///< of the step
    NewtonTrialSums trial_;       ///< at the last trial point
    double bound_ = 0.0;          ///< NewtonTrialSums::bound at the current point
    bool is_frozen_here_ = false; ///< the active set's terms are those of the current point
    DeviceArray<Vec3> gradient_, trial_x_, trial_gradient_;
    DeviceArray<Vec3> before_, kept_;   ///< [vertices] the point before take(), and that of keep() [m]
    DeviceArray<double> energy_;        ///< [vertices and more] parts of the value [J]
    DeviceArray<PaddedVec3> direction_; ///< [vertices] [m]
    DirectionStop stop_;
    CoarseAge coarse_age_{DeviceHessianSolver::kPriceOfCoarse};

    // Contact ahead, see NewtonSpace::model().
    double contact_here_ = 0.0; ///< [J] contact's energy at the current point
    DeviceArray<PaddedVec3> base_;
    DeviceArray<Vec3> gradient_without_contact_, contact_gradient_, model_gradient_;
    DeviceArray<double> contact_energy_;

    RecordScratch sums_;
    DeviceReport<ModelSums> model_report_;
    DeviceReport<NewtonTrialSums> trial_report_;
    DeviceReport<NewtonStartSums> start_report_;
    SumScratch<double> moved_, decrease_;
};

} // namespace toile
