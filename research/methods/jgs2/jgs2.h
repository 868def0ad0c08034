#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/pd/minimiser/outer_loop.h"

namespace toile::research {

/// JGS2: Newton's method in a subspace per vertex, all vertices at once [Lan et al. 2025, "JGS2: near
/// second-order converging Jacobi/Gauss-Seidel for GPU elastodynamics"]. The subspace of vertex i is how the
/// body follows a unit displacement of i, rotated with the body:
///
///   direction_i = -(U_i^T K U_i)^-1 U_i^T g,   U_ij = R_j u_ij R_i^T,   u_i = G(:, i) G_ii^-1,  G =
///   K(rest)^-1
///
/// K is the Hessian at x, projected; R_j is the rotation of vertex j and its neighbours. At rest, however
/// turned, the direction is Newton's.
///
/// Deviations: the paper integrates U_i^T g and U_i^T K U_i by cubature at few elements; here the sums are
/// exact, O(n) for each vertex. The line search is that of OuterLoop. For small bodies: 72 n^2 bytes, and K
/// times 3 n vectors an iteration.
class Jgs2 : public OuterLoop {
public:
    /// @param rest  [vertices] undeformed positions [m]
    explicit Jgs2(std::vector<Vec3> rest) : rest_(std::move(rest)) {}

protected:
    void begin(int) override {}

    /// The first call tabulates the subspaces: one object serves one step length and one set of fixed
    /// vertices.
    /// @throws InvalidInput for another number or inertia of vertices or other fixed ones, and an objective
    ///         without second derivatives
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;

private:
    void tabulate(Hessian& hessian);
    void require_as_tabulated(const HessianParts& parts) const;
    std::vector<Mat3> rotations(View<const Vec3> x) const;

    std::vector<Vec3> rest_;
    std::vector<double> inertia_;              ///< [vertices] when tabulated [N/m]
    std::vector<unsigned char> fixed_;         ///< [vertices] likewise
    std::vector<std::vector<int>> neighbours_; ///< [vertices]
    std::vector<Eigen::MatrixX3d> subspace_;   ///< [vertices] u_i, [3 vertices x 3]
};

} // namespace toile::research
