#pragma once

#include <memory>
#include <vector>

#include "core/linear/device_solver.h"
#include "core/pd/device/body_kernels.h"
#include "core/pd/device/device_descent.h"
#include "core/pd/step_report.h"
#include "core/pd/system.h"

namespace toile {

/// Body on a GPU: implicit Euler steps whose fields stay there. L-BFGS is its method.
class DeviceBody {
public:
    struct Settings {
        double tolerance = 1e-5; ///< [m] as Body's
        int max_iterations = 50; ///< outer iterations per minimisation
    };

    /// @param space      borrowed; the solver's too
    /// @param positions  [vertices] [m]
    /// @param system     its energies are added to those of the device, and its solver is a DeviceSolver
    /// @throws InvalidInput where an energy or the solver has no form for a GPU or the solver runs elsewhere,
    ///         DeviceError where memory is too little
    DeviceBody(const CudaSpace& space, const std::vector<Vec3>& positions, std::unique_ptr<System> system,
               Settings settings);

    // What a step takes, [vertices]; kept until set again.
    void set_acceleration(View<const Vec3> acceleration); ///< [m/s^2] external; none at first
    void set_targets(View<const Vec3> targets);           ///< [m] of fixed vertices; where they are at first
    void set_positions(View<const Vec3> x);               ///< [m]

    // Waited for and copied, [vertices].
    std::vector<Vec3> positions() const { return x_.downloaded(); }  ///< [m]
    std::vector<Vec3> velocities() const { return v_.downloaded(); } ///< [m/s]

    /// Prepares for steps of dt [s] with these vertices fixed, which step() otherwise does: H, its inverse,
    /// and the graph of a minimisation.
    void prepare(double dt, const std::vector<unsigned char>& fixed);

    /// Advances by dt [s]; waits for the end. Same bits in every run.
    /// @param fixed  [vertices] 1 where targets() prescribes the position at the end of the step
    StepReport step(double dt, const std::vector<unsigned char>& fixed);

    const System& system() const { return *system_; }

private:
    DeviceDescent::Problem problem(double dt);
    void begin();
    Descent no_worse_than_standing(Descent found);
    void finish(StepReport& report);

    const CudaSpace& space_;
    std::unique_ptr<System> system_;
    DeviceSolver* solver_; ///< system_'s
    Settings settings_;
    DeviceEnergies energies_;
    double dt_ = 0.0;
    std::vector<unsigned char> host_fixed_;

    DeviceArray<Vec3> x_, v_, acceleration_, targets_, prediction_, drive_, found_, found_gradient_;
    DeviceArray<double> masses_;
    DeviceArray<unsigned char> fixed_;
    DeviceArray<StepSums> begin_sums_;
    DeviceArray<FinishSums> finish_sums_, finish_;
    PinnedArray<FinishSums> finish_on_host_;
    DeviceDescent descent_;
};

} // namespace toile
