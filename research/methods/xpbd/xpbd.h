#pragma once

#include "garment/energy/membrane_kernels.h"
#include "research/methods/baseline_method.h"
#include "research/methods/xpbd/constraint_blocks.h"

namespace toile::research {

/// Extended position-based dynamics [Macklin et al. 2016] in small steps [Macklin et al. 2019]. Every step
/// has substeps of one coloured Gauss-Seidel pass over the constraints, with multipliers starting at zero.
///
/// The energies 1/2 C^T alpha^(-1) C of the constraints are the terms of Membrane and Bending
/// (strain_constraints.h, constraint_blocks.h). More substeps therefore converge to the motion of Body with
/// ever smaller steps. Same bits for every thread count.
///
/// The report counts substeps as iterations. Its displacement is the maximum by which the constraints of the
/// last substep moved a vertex. There is no convergence criterion.
class Xpbd : public BaselineMethod {
public:
    struct Settings {
        int substeps = 20; ///< per step, at least 1

        /// Applies bending by its forces at the start of a substep if h^2 times the bound of K / m allows it
        /// (kExplicitBending), else as constraints. Our addition, not the paper's. The passes over the
        /// stencils cost twice those over the triangles, the forces a fifth.
        bool bend_by_forces = true;
    };

    /// Colours the constraints. O(triangles).
    /// @throws InvalidInput as Membrane and Bending do, and for less than one substep.
    Xpbd(std::vector<Vec3> positions, garment::ClothModel cloth, Settings settings);

    /// Numbers of colours: constraints of the triangles, bending stencils.
    int strain_colour_count() const { return int(layout_.strain_colours.size()); }
    int curvature_colour_count() const { return int(layout_.curvature_colours.size()); }

private:
    StepReport advance(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                       View<const Vec3> targets) override;
    bool bends_by_forces(double h) const;
    void predict(double h, double end, View<const Vec3> acceleration, View<const Vec3> targets);
    void project(double h);

    Settings settings_;
    garment::MembraneWeights weights_;
    SparseMatrix bending_; ///< K [N/m]
    double fastest_ = 0.0; ///< [1/s^2] bound on the eigenvalues of K / m
    ConstraintLayout layout_;
    std::vector<double> inverse_masses_;
    std::vector<Vec3> before_; ///< [vertices] at the start of the substep [m]
};

} // namespace toile::research
