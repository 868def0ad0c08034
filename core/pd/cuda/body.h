#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/base/error.h"
#include "core/compute/cuda/mirrored_array.h"
#include "core/linear/cuda/solver.h"
#include "core/pd/cuda/acceleration.h"
#include "core/pd/cuda/body_kernels.h"
#include "core/pd/cuda/contact_descent.h"
#include "core/pd/cuda/descent.h"
#include "core/pd/cuda/newton/device_newton.h"
#include "core/pd/cuda/projection.h"
#include "core/pd/energy/system.h"
#include "core/pd/minimiser/outer_method.h"
#include "core/pd/preconditioner/nested_pcg.h"
#include "core/pd/step/bdf2.h"
#include "core/pd/step/point_masses.h"
#include "core/pd/step/take_step.h"

namespace toile {

/// Body on a GPU: steps minimised on the device by Newton's method or L-BFGS. Fields are copied to the host
/// only when contact or a caller reads them there.
class DeviceBody : public PointMasses, private StepSpace {
public:
    struct Settings {
        double tolerance = 1e-5;                                 ///< [m] as Body's
        int max_iterations = 50;                                 ///< outer iterations per minimisation
        int max_passes = 3;                                      ///< see StepPasses
        Pcg::Settings contact_solve = NestedPcg::Settings{}.pcg; ///< while contacts are active
        StepStop stop = StepStop::Error;                         ///< what the tolerance bounds
        Integrator integrator = Integrator::ImplicitEuler;
        OuterMethod outer = OuterMethod::Lbfgs; ///< or Newton
        double speed_tolerance = 0.01;          ///< [m/s] of Newton's method, in place of `tolerance`
        Extent extent = Extent::Surface;        ///< as Body's
        bool begins_by_local_global = true;     ///< as Body's
    };

    /// @param space      borrowed; the solver's too
    /// @param positions  [vertices] [m]
    /// @param system     its energies are added to those of the device, and its solver is a DeviceSolver
    /// @throws InvalidInput if an energy or the solver has no GPU form or the solver runs elsewhere,
    ///         DeviceError if there is too little memory
    DeviceBody(const CudaSpace& space, const std::vector<Vec3>& positions, std::unique_ptr<System> system,
               Settings settings);

    /// Prepares for steps of dt [s] with these vertices fixed: H, its inverse, and the graphs of a
    /// minimisation. Otherwise step() does so.
    void prepare(double dt, const std::vector<unsigned char>& fixed) override;

    /// Sets the external acceleration of all later steps, in place of step()'s `acceleration`, which is then
    /// empty. The body's fields need not be copied to the host for it.
    void accelerate_by(std::unique_ptr<DeviceAcceleration> loads) { loads_ = std::move(loads); }

    /// Advances by a step and waits for its end. Same bits in every run. Copies only the fixed entries of
    /// `targets`.
    /// @param active, projection  have GPU forms (on_device), or are null
    /// @throws InvalidInput if one has none
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection) override;

    View<const Vec3> positions() const override { return x_.host(); }
    View<const Vec3> velocities() const override { return v_.host(); }
    std::shared_ptr<const Readback<Vec3>> read_back_positions() override;
    void set_positions(View<const Vec3> x) override;
    void set_velocities(View<const Vec3> v) override;
    void set_stiff_parts(const std::vector<int>& of_vertex) override;
    void begin_anew() override;
    double max_speed() const override;
    View<const double> masses() const override { return system_->masses(); }

    const System& system() const { return *system_; }

private:
    void begin(const StepInput& input) override;
    StepStart start() const override;
    StepField end_positions() override { return x_t1_; }
    StepField end_velocities() override { return v_; }
    OuterLoop::Outcome minimise(ActiveSetEnergy* active, int max_iterations, bool is_first) override;
    OuterLoop::Outcome minimise_by_newton(const Newton::Settings& settings, const Newton::Revise& revise,
                                          bool is_calm) override;
    void restart_touching(const StepInput& input) override;
    void mark_touching(ActiveSetEnergy& active) override;
    double local_error() override;
    void abandon() override;
    void finish(StepProjection* projection) override;
    void project(StepProjection& projection, const std::function<bool()>& clear_contacts) override;
    void end(StepProjection* projection, StepReport& report) override;

    static void overwrite(MirroredArray<Vec3>& field, View<const Vec3> values);
    void set_fixed(const std::vector<unsigned char>& fixed);
    void begin_forces(View<const Vec3> acceleration);
    void begin_targets(View<const Vec3> targets);
    DeviceDescent::Problem problem();
    DescentFields fields() { return descent_->fields(problem()); }
    MotionView motion();
    void forget_touching();
    void restart_all();
    void predict();
    void predict_motion();
    OuterLoop::Outcome minimise_free(bool is_first);
    OuterLoop::Outcome minimise_with_contact(DeviceActiveSet& contact, int limit, bool is_first);
    void prepare_contact();
    OuterLoop::Outcome run_with_contact(DeviceActiveSet& contact, const OuterLoop::Settings& settings,
                                        double value);
    void begin_at(View<const Vec3> x);
    void stand_still();
    void keep_found();
    void take_found();

    const CudaSpace& space_;
    std::unique_ptr<System> system_;
    DeviceSolver* solver_; ///< system_'s
    Settings settings_;
    DeviceEnergies energies_;
    double dt_ = 0.0;            ///< of the current step [s]
    double prepared_step_ = 0.0; ///< [s] Bdf2::implicit_step() of H; 0: none
    Descent asked_;              ///< inputs at the start of the step: tolerance, mass, driving
    std::vector<unsigned char> host_fixed_;

    std::unique_ptr<DeviceAcceleration> loads_; ///< null: step()'s acceleration is used
    MirroredArray<Vec3> x_, v_, x_t1_, acceleration_, prediction_;
    ReadbackPool<Vec3> readbacks_;
    DeviceArray<Vec3> targets_;       ///< [vertices] where fixed
    DeviceArray<int> fixed_vertices_; ///< vertices that are fixed
    std::vector<int> fixed_vertices_on_host_;
    DeviceArray<Vec3> fixed_targets_; ///< [fixed vertices]
    PinnedArray<Vec3> fixed_targets_on_host_;
    Newton::Patience patience_;
    // State of the integrator: see MotionView.
    Bdf2 scheme_;
    double previous_dt_ = 0.0; ///< [s] 0: there was no step before
    DeviceArray<Vec3> x_previous_, v_previous_;
    DeviceArray<unsigned char> restart_, touched_, touches_;
    DeviceArray<int> stiff_part_;
    DeviceArray<unsigned char> part_touched_, part_touches_;
    DeviceArray<unsigned char> restart_before_; ///< restart_ before the step
    SumScratch<StepErrorSum> error_sums_;
    DeviceArray<Vec3> minimiser_; ///< [vertices] [m]
    DeviceArray<double> inertia_; ///< [vertices] [N/m]

    DeviceArray<Vec3> found_;
    DeviceArray<double> masses_, diagonal_; ///< [kg]; of H [N/m]
    DeviceArray<double> inverse_masses_;    ///< [1/kg] 0 where fixed
    DeviceArray<unsigned char> fixed_;
    DeviceArray<StepSums> begin_sums_;
    DeviceArray<FinishSums> finish_sums_;
    DeviceArray<LargestSquare> end_sums_;
    PinnedArray<FinishSums> finished_;  ///< [1]
    PinnedArray<LargestSquare> speed_;  ///< [1]
    bool is_speed_current_ = false;     ///< speed_ belongs to the current velocities
    ActiveSetEnergy* active_ = nullptr; ///< of the current step; may be null
    std::optional<DeviceNewton> newton_;

    // L-BFGS.
    std::optional<DeviceDescent> descent_; ///< none: Newton's method
    DeviceArray<Vec3> drive_, found_gradient_;
    std::unique_ptr<DeviceContactDescent> contact_descent_; ///< null before contact is first active
    bool is_contact_prepared_ = false;                      ///< contact_descent_ has the current H
};

} // namespace toile
