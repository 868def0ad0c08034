#pragma once

#include <algorithm>
#include <vector>

#include "core/compute/cuda/runtime/graph.h"
#include "core/compute/cuda/runtime/timer.h"

namespace toile::research::gpu {

/// Repetitions within a graph, which hides the launch time, and launches whose median counts.
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

} // namespace toile::research::gpu
