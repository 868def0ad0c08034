#pragma once

#include <functional>

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/graph.h"
#include "core/backend/cuda/sum_scratch.h"
#include "core/pd/device/descent_kernels.h"
#include "core/pd/device/device_energy.h"

namespace toile {

/// Runs a Descent: its fields, and its turns as a graph.
class DeviceDescent {
public:
    /// What is minimised: inertia and more. Functions enqueue; what they launch is recorded.
    struct Problem {
        /// Adds to shares of the value, writes those of no vertex, and adds to the gradient.
        std::function<void(const DeviceEvaluation&)> add_gradient;
        /// z = B g, whatever g is at fixed vertices.
        std::function<void(View<const Vec3> g, View<Vec3> z)> precondition;
        View<const double> masses;       ///< [vertices] [kg]
        View<const unsigned char> fixed; ///< [vertices]
        View<const Vec3> prediction;     ///< [vertices] q* [m]
        View<const Vec3> drive;          ///< [vertices] q* - x0 [m]
        double dt = 0.0;                 ///< [s]
    };

    /// @param share_count  shares of the value that belong to no vertex
    DeviceDescent(const CudaSpace& space, int vertex_count, int share_count);

    /// Takes another problem.
    void record(const Problem& problem);

    /// Fields of the problem. Before run() the caller puts the point to begin at into trial.x, begins its
    /// gradient (begin_trial()), and what is asked into descent.
    DescentFields fields(const Problem& problem);

    /// Enqueues turns until the descent is over, reading back now and then whether it is. As many turns as
    /// the run before took go at once.
    Descent run();

    /// What is asked and what has come of it, waited for.
    const Descent& state();

    /// Enqueues the fewest turns that can be, which tell the value where it begins, and reads back.
    Descent run_briefly();

    /// The point that run() found, and the objective's gradient there.
    View<Vec3> x() { return x_.view(); }
    View<Vec3> gradient() { return gradient_.view(); }

private:
    void enqueue_turn(const Problem& problem);

    const CudaSpace& space_;
    DeviceArray<Vec3> x_, gradient_, z_, trial_x_, trial_gradient_, trial_z_;
    DeviceArray<double> energy_;
    DeviceArray<PaddedVec3> direction_, s_, y_, w_;
    DeviceArray<Descent> descent_;
    RecordScratch sums_;
    PinnedArray<Descent> on_host_;
    CudaGraph turns_, few_turns_;
    int expected_turns_;
};

} // namespace toile
