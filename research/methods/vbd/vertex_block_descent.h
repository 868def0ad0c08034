#pragma once

#include "research/methods/baseline_method.h"
#include "research/methods/vbd/vertex_sweep.h"

namespace toile::research {

/// Vertex block descent [Chen et al. 2024] on the objective of Body:
///
///   E(x) = 1/(2 dt^2) |x - q*|^2_M + W_membrane(x) + W_bending(x)
///
/// A sweep visits the vertices colour by colour and moves each by one Newton step on its three unknowns,
/// x_i -= H_i^(-1) dE/dx_i (section 3.2). H_i is projected to be positive definite (membrane_corner.h); the
/// paper does not project it and skips singular ones. Neither the paper nor we use a line search. Same bits
/// for every thread count.
class VertexBlockDescent : public BaselineMethod {
public:
    /// Initial iterate of the sweeps.
    enum class Start {
        Prediction, ///< q* = x + dt v + dt^2 a
        Adaptive    ///< the part of a that the vertex followed in the last step (section 3.7)
    };
    struct Settings {
        int max_sweeps = 50;
        double tolerance = 0.0; ///< [m] stop if no vertex moved farther in a sweep; 0: all sweeps

        /// [-] Estimate of the spectral radius for Chebyshev acceleration (section 3.8), 0 for none. If it is
        /// too close to 1 for the number of sweeps, the cloth explodes (docs/journal/baselines.md).
        double rho = 0.0;
        Start start = Start::Adaptive;
    };

    /// Colours the vertices and lays out the sweep. O(vertices).
    /// @throws InvalidInput as Membrane and Bending do.
    VertexBlockDescent(std::vector<Vec3> positions, garment::ClothModel cloth, Settings settings);

    /// Number of colours, and of barriers per sweep; vertices of one colour share no term of E.
    int colour_count() const { return int(layout_.colours.size()); }

private:
    StepReport advance(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                       View<const Vec3> targets) override;
    void begin(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
               View<const Vec3> targets);
    double sweep(double dt, const std::vector<unsigned char>& fixed);
    void accelerate(int sweep);

    Settings settings_;
    garment::MembraneWeights weights_;
    SweepLayout layout_;
    std::vector<Vec3> prediction_, velocity_before_;
    std::vector<Vec3> last_, before_last_; ///< iterates of the Chebyshev recurrence
    double omega_ = 1.0;
    std::vector<double> moved_; ///< [blocks] maximum squared displacement [m^2]
};

} // namespace toile::research
