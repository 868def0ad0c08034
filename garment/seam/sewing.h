#pragma once

#include <vector>

#include "core/pd/energy/energy.h"

namespace toile::garment {

/// Threads that pull the edges of panels together: springs between pairs of vertices, which are slack up to
/// their length l_j. Their force is bounded, so that panels that start far apart do not fly.
///
///   W = sum_j  k h(|x_a - x_b| - l_j),
///   h(r) = 0  for r <= 0,   r^2 / 2  for r <= r_0,   r_0 (r - r_0 / 2)  beyond     [Huber 1964]
///
/// with r_0 = max_force / k. All l_j are 0 unless set_length() changes them.
class Sewing : public Energy {
public:
    struct Settings {
        double stiffness = 1000.0; ///< [N/m] k of each thread
        double max_force = 0.5;    ///< [N] of each thread
    };
    struct Thread {
        int a = 0, b = 0; ///< vertices
    };

    /// @throws InvalidInput for settings that are not positive
    Sewing(std::vector<Thread> threads, const Settings& settings);

    std::string_view name() const override { return "garment/sewing"; }
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets&) const override {}
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override;
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;

    const std::vector<Thread>& threads() const { return threads_; }

    double length(int thread) const { return lengths_[size_t(thread)]; } ///< [m]
    /// @param length  [m] 0 or more; infinite: the thread does not pull
    void set_length(int thread, double length) { lengths_[size_t(thread)] = length; }

private:
    double tension_over_distance(double distance, double length) const;

    std::vector<Thread> threads_;
    std::vector<double> lengths_; ///< [threads] [m]
    Settings settings_;
};

/// Distances between the ends of threads.
struct SeamGaps {
    double max = 0.0;  ///< [m]
    double mean = 0.0; ///< [m]
    int widest = -1;   ///< thread; -1: there are none
};
SeamGaps gaps_of(const std::vector<Sewing::Thread>& threads, View<const Vec3> x);

} // namespace toile::garment
