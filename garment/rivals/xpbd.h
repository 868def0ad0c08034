#pragma once

#include "garment/rivals/constraint_blocks.h"
#include "garment/rivals/rival.h"

namespace toile {

/// Extended position-based dynamics [Macklin et al. 2016] in small steps [Macklin et al. 2019]: every step is
/// cut into substeps of one coloured Gauss-Seidel pass over the constraints each, multipliers beginning at
/// zero.
///
/// The constraints are those whose energies 1/2 C^T alpha^(-1) C are Membrane's and Bending's terms
/// (strain_constraints.h, constraint_blocks.h), so that more substeps lead to the same motion that Body finds
/// with ever smaller steps. Same bits for every thread count.
///
/// The report counts substeps as iterations; its displacement is the farthest that the constraints of the
/// last substep moved a vertex. There is no criterion of convergence.
class Xpbd : public Rival {
public:
    struct Settings {
        int substeps = 20; ///< per step, at least 1

        /// Bending acts by its forces at the start of a substep where h^2 bounds of K / m allow it
        /// (kExplicitBending), else as constraints. Ours, not the paper's: the passes over the stencils cost
        /// twice those over the triangles, the forces a fifth.
        bool bend_by_forces = true;
    };

    /// Colours the constraints. O(triangles).
    /// @throws InvalidInput as Membrane and Bending do, and for less than one substep.
    Xpbd(std::vector<Vec3> positions, ClothModel cloth, Settings settings);

    /// Colours of the triangles' constraints and of the bending stencils.
    int strain_colour_count() const { return int(layout_.strain_colours.size()); }
    int curvature_colour_count() const { return int(layout_.curvature_colours.size()); }

private:
    StepReport advance(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                       View<const Vec3> targets) override;
    bool bends_by_forces(double h) const;
    void predict(double h, double end, View<const Vec3> acceleration, View<const Vec3> targets);
    void project(double h);

    Settings settings_;
    MembraneWeights weights_;
    SparseMatrix bending_; ///< K [N/m]
    double fastest_ = 0.0; ///< [1/s^2] bound on the eigenvalues of K / m
    ConstraintLayout layout_;
    std::vector<double> inverse_masses_;
    std::vector<Vec3> before_; ///< [vertices] at the start of the substep [m]
};

} // namespace toile
