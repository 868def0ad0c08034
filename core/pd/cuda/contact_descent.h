#pragma once

#include <functional>

#include "core/compute/cuda/report.h"
#include "core/compute/cuda/sum_scratch.h"
#include "core/pd/cuda/contact_descent_kernels.h"
#include "core/pd/cuda/descent.h"
#include "core/pd/cuda/nested_pcg.h"
#include "core/pd/minimiser/outer_loop.h"

namespace toile {

/// OuterLoop with L-BFGS around NestedPcg while contact is active, with its fields on a GPU. The number of
/// PCG iterations is known only at run time, so the host decides between kernels. DeviceDescent, whose
/// inverse is constant, needs no such decisions.
class DeviceContactDescent {
public:
    /// Settings and data of the step.
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

    /// Takes another problem. @param problem  borrowed, like the views in it
    void set_problem(const DeviceDescent::Problem& problem) { add_gradient_ = problem.add_gradient; }

    /// Objective at fields.trial.x, where begin_trial() has begun its gradient.
    double evaluate(const DescentFields& fields, DeviceActiveSet& active);

    /// Minimises from the point of the last evaluate(), whose value is `value`. The result is in fields.here.
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
    /// Adds the gradient of everything but contact. Not a graph, whose kernels could not start before others
    /// end.
    std::function<void(const DeviceEvaluation& at)> add_gradient_;
    RecordScratch sums_;
    DeviceReport<ContactTrialSums> trial_;
    bool has_active_contact_ = false; ///< contact is active at the trial point
    DeviceArray<double> of_s_;        ///< output of FindCoefficients
};

} // namespace toile
