#pragma once

#include <vector>

#include "core/pd/energy/energy.h"

namespace toile::garment {

/// Threads that pull the edges of panels together: springs of zero rest length between pairs of vertices.
/// Their force is bounded, so that panels that start far apart do not fly.
///
///   W = sum_j  k h(|x_a - x_b|),   h(r) = r^2 / 2  for r <= r_0,  r_0 (r - r_0 / 2)  beyond     [Huber 1964]
///
/// with r_0 = max_force / k.
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

private:
    std::vector<Thread> threads_;
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
