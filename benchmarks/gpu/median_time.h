#pragma once

#include <algorithm>
#include <vector>

#include "core/backend/cuda/graph.h"
#include "core/backend/cuda/timer.h"

namespace toile::gpu {

/// Repetitions in a graph, so that its launch is no part of the time, and launches of which the median
/// counts.
inline constexpr int kRepeats = 20;
inline constexpr int kLaunches = 15;

/// Median time of work() on the device [us].
template <typename Work>
double median_us(const CudaSpace& space, const Work& work)
{
    CudaGraph graph(space, "benchmarks/repeats");
    graph.record([&] {
        for (int k = 0; k < kRepeats; ++k)
            work();
    });
    graph.launch();
    DeviceTimer timer(space);
    std::vector<double> times;
    for (int k = 0; k < kLaunches; ++k) {
        timer.start();
        graph.launch();
        timer.stop();
        times.push_back(1e3 * timer.elapsed_ms() / kRepeats);
    }
    std::nth_element(times.begin(), times.begin() + kLaunches / 2, times.end());
    return times[kLaunches / 2];
}

} // namespace toile::gpu
