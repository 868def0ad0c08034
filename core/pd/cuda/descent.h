#pragma once

#include <functional>

#include "core/compute/cuda/array.h"
#include "core/compute/cuda/runtime/graph.h"
#include "core/compute/cuda/sum_scratch.h"
#include "core/pd/cuda/descent_kernels.h"
#include "core/pd/cuda/energy.h"

namespace toile {

/// Runs a Descent: owns its fields and records its evaluations as a graph.
class DeviceDescent {
public:
    /// Objective: inertia plus further terms. Functions enqueue; their launches are recorded.
    struct Problem {
        /// Adds to the vertices' parts of the value and to the gradient; overwrites the parts that belong to
        /// no vertex.
        std::function<void(const DeviceEvaluation&)> add_gradient;
        /// Computes z = B g, for any g at fixed vertices.
        std::function<void(View<const Vec3> g, View<Vec3> z)> precondition;
        View<const double> masses;       ///< [vertices] [kg]
        View<const unsigned char> fixed; ///< [vertices]
        View<const Vec3> prediction;     ///< [vertices] q* [m]
        View<const Vec3> drive;          ///< [vertices] q* - x0 [m]
        View<const double> inertia;      ///< [vertices] [N/m]
    };

    /// @param partial_count  parts of the value that belong to no vertex
    DeviceDescent(const CudaSpace& space, int vertex_count, int partial_count);

    /// Records the graphs of another problem.
    void record(const Problem& problem);

    /// Fields of the problem. Before run() the caller writes the start point to trial.x, begins its gradient
    /// (begin_trial()), and writes the inputs to `descent`.
    DescentFields fields(const Problem& problem);

    /// Enqueues evaluations until the descent is over, and reads back at intervals whether it is. First
    /// enqueues as many as the previous run needed, without reading back.
    Descent run();

    /// Inputs and results. Waits.
    const Descent& state();

    /// Enqueues the minimum number of evaluations, which give the value at the start point, and reads back.
    Descent run_briefly();

    /// Point that run() found, and the gradient of the objective there.
    View<Vec3> x() { return x_.view(); }
    View<Vec3> gradient() { return gradient_.view(); }

private:
    void enqueue_evaluation(const Problem& problem);

    const CudaSpace& space_;
    DeviceArray<Vec3> x_, gradient_, z_, trial_x_, trial_gradient_, trial_z_;
    DeviceArray<double> energy_;
    DeviceArray<PaddedVec3> direction_, s_, y_, w_;
    DeviceArray<Descent> descent_;
    RecordScratch sums_;
    PinnedArray<Descent> on_host_;
    CudaGraph graph_, short_graph_;
    int expected_evaluations_;
};

} // namespace toile
