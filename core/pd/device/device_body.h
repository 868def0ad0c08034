#pragma once

#include <memory>
#include <vector>

#include "core/backend/cuda/mirrored_array.h"
#include "core/linear/device_solver.h"
#include "core/pd/device/body_kernels.h"
#include "core/pd/device/device_acceleration.h"
#include "core/pd/device/device_contact_descent.h"
#include "core/pd/device/device_descent.h"
#include "core/pd/device/device_projection.h"
#include "core/pd/nested/nested_pcg.h"
#include "core/pd/point_masses.h"
#include "core/pd/system.h"

namespace toile {

/// Body on a GPU: implicit Euler steps minimised there. L-BFGS is its method. Fields are copied where contact
/// or others ask for them on the host and not otherwise.
class DeviceBody : public PointMasses {
public:
    struct Settings {
        double tolerance = 1e-5;                                 ///< [m] as Body's
        int max_iterations = 50;                                 ///< outer iterations per minimisation
        int max_rounds = 3;                                      ///< see StepRounds
        Pcg::Settings contact_solve = NestedPcg::Settings{}.pcg; ///< while contacts are active
        StepStop stop = StepStop::Error;                         ///< what the tolerance bounds
    };

    /// @param space      borrowed; the solver's too
    /// @param positions  [vertices] [m]
    /// @param system     its energies are added to those of the device, and its solver is a DeviceSolver
    /// @throws InvalidInput where an energy or the solver has no form for a GPU or the solver runs elsewhere,
    ///         DeviceError where memory is too little
    DeviceBody(const CudaSpace& space, const std::vector<Vec3>& positions, std::unique_ptr<System> system,
               Settings settings);

    /// Prepares for steps of dt [s] with these vertices fixed, which step() otherwise does: H, its inverse,
    /// and the graphs of a minimisation.
    void prepare(double dt, const std::vector<unsigned char>& fixed) override;

    /// What accelerates the vertices in every step from now on, instead of step()'s `acceleration`, which is
    /// empty then: nothing of the body has to come to the host for it.
    void accelerate_by(std::unique_ptr<DeviceAcceleration> loads) { loads_ = std::move(loads); }

    /// Waits for the end. Same bits in every run. Of `targets` only what is fixed is copied.
    /// @param active, projection  have forms for a GPU (on_device), or are null
    /// @throws InvalidInput where one has none
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection) override;

    View<const Vec3> positions() const override { return x_.host(); }
    View<const Vec3> velocities() const override { return v_.host(); }
    std::shared_ptr<const Readback<Vec3>> read_back_positions() override;
    void set_positions(View<const Vec3> x) override { overwrite(x_, x); }
    void set_velocities(View<const Vec3> v) override;
    double max_speed() const override;
    View<const double> masses() const override { return system_->masses(); }

    const System& system() const { return *system_; }

private:
    static void overwrite(MirroredArray<Vec3>& field, View<const Vec3> values);
    void hold(const std::vector<unsigned char>& fixed);
    void begin_forces(View<const Vec3> acceleration);
    void begin_targets(View<const Vec3> targets);
    DeviceDescent::Problem problem(double dt);
    DescentFields fields() { return descent_.fields(problem(dt_)); }
    void predict();
    void begin_contact(ActiveSetEnergy& active);
    void minimise(ActiveSetEnergy* active, StepReport& report);
    OuterLoop::Outcome minimise_free(bool is_first);
    OuterLoop::Outcome minimise_touching(DeviceActiveSet& contact, int limit, bool is_first);
    void prepare_touching();
    OuterLoop::Outcome run_touching(DeviceActiveSet& contact, const OuterLoop::Settings& settings,
                                    double value);
    void begin_at(View<const Vec3> x);
    void stand_still();
    void keep_found();
    void take_found();
    void finish();
    void end(DeviceStepProjection* limits, StepReport& report);
    void satisfy(ActiveSetEnergy* active, DeviceStepProjection* limits);
    void project(DeviceStepProjection& limits, const ActiveSetEnergy* active);

    const CudaSpace& space_;
    std::unique_ptr<System> system_;
    DeviceSolver* solver_; ///< system_'s
    Settings settings_;
    DeviceEnergies energies_;
    double dt_ = 0.0;
    Descent asked_; ///< as the step began: tolerance, mass, driving
    std::vector<unsigned char> host_fixed_;

    std::unique_ptr<DeviceAcceleration> loads_; ///< null: the caller's acceleration
    MirroredArray<Vec3> x_, v_, x_t1_, acceleration_, prediction_;
    ReadbackPool<Vec3> readbacks_;
    DeviceArray<Vec3> targets_; ///< [vertices] where held
    DeviceArray<int> held_;     ///< vertices that are fixed
    std::vector<int> host_held_;
    DeviceArray<Vec3> held_targets_; ///< [held]
    PinnedArray<Vec3> held_targets_on_host_;
    DeviceArray<Vec3> drive_, found_, found_gradient_;
    DeviceArray<double> masses_, diagonal_; ///< [kg]; of H [N/m]
    DeviceArray<double> inverse_masses_;    ///< [1/kg] 0 where fixed
    DeviceArray<unsigned char> fixed_;
    DeviceArray<StepSums> begin_sums_;
    DeviceArray<LargestSquare> end_sums_;
    PinnedArray<LargestSquare> gradient_, speed_; ///< [1]
    bool knows_speed_ = false;                    ///< speed_ is of the velocities as they are
    DeviceDescent descent_;
    std::unique_ptr<DeviceContactDescent> contact_descent_; ///< null before contact first acts
    bool is_touching_prepared_ = false;                     ///< contact_descent_ knows H
};

} // namespace toile
