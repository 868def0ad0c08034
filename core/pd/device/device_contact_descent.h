#pragma once

#include <functional>

#include "core/backend/cuda/report.h"
#include "core/backend/cuda/sum_scratch.h"
#include "core/pd/device/contact_descent_kernels.h"
#include "core/pd/device/device_descent.h"
#include "core/pd/device/device_nested_pcg.h"
#include "core/pd/outer_loop.h"

namespace toile {

/// OuterLoop with L-BFGS around NestedPcg while contact acts, its fields on a GPU. How many iterations
/// contact's inverse takes is known only there and then, so the host decides between kernels; a DeviceDescent
/// whose inverse never changes does without.
class DeviceContactDescent {
public:
    /// What the step asks.
    struct Task {
        OuterLoop::Settings settings;
        StepStop stop = StepStop::Error;
        double mass = 0.0;    ///< [kg] of the free vertices
        double driving = 0.0; ///< StepError::Sums::driving of the step
        double dt = 0.0;      ///< [s]
    };

    DeviceContactDescent(const CudaSpace& space, int vertex_count, const Pcg::Settings& contact_solve);

    /// Takes another H. @param solver  its inverse, borrowed
    void prepare(const System& system, DeviceSolver& solver);

    /// Takes another problem. @param problem  borrowed for what it borrows
    void set_problem(const DeviceDescent::Problem& problem) { add_gradient_ = problem.add_gradient; }

    /// The objective at fields.trial.x, begun there (begin_trial()).
    double evaluate(const DescentFields& fields, DeviceActiveSet& active);

    /// Minimises from the point of the last evaluate(), whose value is given. What it finds is fields.here.
    OuterLoop::Outcome minimise(const DescentFields& fields, DeviceActiveSet& active, const Task& task,
                                double value);

private:
    ContactTrialSums measure(const DescentFields& fields, DeviceActiveSet& active, double step);
    int find_direction(const DescentFields& fields, DeviceActiveSet& active);
    bool search(const DescentFields& fields, DeviceActiveSet& active, ContactTrialSums& trial,
                LineSearch& line);
    void restart(const DescentFields& fields, DeviceActiveSet& active);
    void take(const DescentFields& fields, const StepProducts* products);

    const CudaSpace& space_;
    DeviceSolver* solver_ = nullptr;
    DeviceNestedPcg pcg_;
    TwoLoop pairs_;
    /// Everything of the objective but contact. Not a graph: its kernels would not come early after others.
    std::function<void(const DeviceEvaluation& at)> add_gradient_;
    RecordScratch sums_;
    DeviceReport<ContactTrialSums> trial_;
    bool acts_ = false;        ///< contact, where the trial is
    DeviceArray<double> of_s_; ///< FindCoefficients'
};

} // namespace toile
