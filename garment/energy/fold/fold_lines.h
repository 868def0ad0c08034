#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/pd/energy/energy.h"
#include "garment/energy/fold/dihedral_angle.h"
#include "garment/energy/fold/fold_edge.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Moments that hold folds at their rest angle: pressed pleats, creases, seams that are folded.
///
///   W = sum_e  k_e l_e / 2 (theta_e - theta0_e)^2        [Grinspun et al. 2003, stiffness per length]
///
/// theta is the dihedral angle (dihedral_angle.h), l the edge's length at rest. Cloth does not bend across a
/// fold beside that: see Bending's hinges.
///
/// The angle is continuous beyond half a turn: within a step it is that within half a turn of the angle at
/// the start of the step. Otherwise a fold of 180 degrees would turn over where rounding takes it past that.
class FoldLines : public Energy {
public:
    /// @param x  [vertices] start positions; see restart() [m]
    /// @throws InvalidInput naming `source` and an edge at the border, or a value outside of its range
    FoldLines(const RestShape& rest, const std::vector<FoldEdge>& folds, View<const Vec3> x,
              const std::string& source);

    /// Begins a step at x [vertices], for the continuous angle.
    void begin_step(View<const Vec3> x);

    /// Forgets earlier steps: angles are those from -pi to pi. An edge that is folded flat, to 1e-3 rad, is
    /// so to the side to which it is folded at rest.
    void restart(View<const Vec3> x);

    /// Angle of a fold at the start of the step [rad].
    double start_angle(int fold) const { return folds_[fold].start; }

    std::string_view name() const override { return "garment/fold_lines"; }

    /// Bound of the Hessian where triangles have the shape that they have at rest.
    void add_hessian(Triplets& H) const override;
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) override;
    void add_constant_curvature(Triplets&) const override {}
    void add_couplings(std::vector<std::pair<int, int>>& couplings) const override;

    /// Positive semi-definite it is Gauss and Newton's: without the second derivative of the angle.
    void add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K) override;

private:
    struct Fold {
        std::array<int, 4> vertex{};                   ///< v0, v1, a, b of HingeCorners
        std::array<std::array<double, 4>, 2> weight{}; ///< [triangles] of the flat gradient at rest [1/m]
        std::array<double, 2> height{};                ///< [triangles] smallest at rest [m]
        double rest_angle = 0.0;                       ///< [rad] at rest
        double stiffness = 0.0;                        ///< [N m] of the whole edge
        double start = 0.0;                            ///< [rad] at the start of the step

        HingeCorners corners(View<const Vec3> x) const
        {
            return {x[vertex[0]], x[vertex[1]], x[vertex[2]], x[vertex[3]]};
        }
        double angle_near_start(View<const Vec3> x) const;
    };
    static Fold fold_of(const RestShape& rest, const FoldEdge& edge);

    std::vector<Fold> folds_;
};

} // namespace toile::garment
