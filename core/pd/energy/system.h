#pragma once

#include <memory>
#include <vector>

#include "core/linear/direct_solver.h"
#include "core/pd/energy/curvature.h"

namespace toile {

/// Constant part of a body's implicit Euler step:
///
///   E(x) = 1/(2 dt^2) |x - q*|^2_M + sum_j W_j(x),     H = M/dt^2 + sum_j w_j S_j^T A_j^T A_j S_j
///
/// [Bouaziz et al. 2014, eq. 2, 3 and 10]. H is [vertices x vertices] and serves x, y and z. Fixed vertices
/// are eliminated: their rows and columns of H are the identity's and their gradient is zero.
class System {
public:
    /// @param masses    [vertices] [kg], positive
    /// @param energies  the terms W_j; shared because caller and system both evaluate them
    /// @param solver    the global step
    System(std::vector<double> masses, std::vector<std::shared_ptr<Energy>> energies,
           std::unique_ptr<GlobalSolver> solver = std::make_unique<DirectSolver>());

    int vertex_count() const { return int(masses_.size()); }
    View<const double> masses() const { return masses_; }
    View<const unsigned char> fixed() const { return fixed_; }

    /// Called before every step: prepares H and its solver for a time step [s] and a set of fixed vertices.
    /// If neither changed, only calls the solver's begin_step().
    void prepare(double dt, const std::vector<unsigned char>& fixed);

    /// Called before every step of a minimiser without H: in place of prepare(), only for diagonal() and
    /// fixed().
    void prepare_diagonal(double dt, const std::vector<unsigned char>& fixed);

    /// Diagonal of H with nothing fixed [N/m].
    View<const double> diagonal() const { return diagonal_; }
    const SparseMatrix& matrix() const { return H_; }
    const GlobalSolver& solver() const { return *solver_; }
    GlobalSolver& solver() { return *solver_; }
    const std::vector<std::shared_ptr<Energy>>& energies() const { return energies_; }

    /// Energies at x [J]; adds their gradients [N].
    double add_gradient(View<const Vec3> x, View<Vec3> gradient) const;

    /// True Hessian of the energies; built at the first call, so that other methods do not pay for it.
    Curvature& curvature() const;

private:
    void update();

    std::vector<double> masses_;
    std::vector<std::shared_ptr<Energy>> energies_;
    std::vector<unsigned char> fixed_;
    SparseMatrix elastic_; ///< sum of the energies' parts, without mass
    SparseMatrix H_;
    std::vector<double> diagonal_;
    std::unique_ptr<GlobalSolver> solver_;
    mutable std::unique_ptr<Curvature> curvature_;
    double dt_ = 0.0;         ///< [s] of the diagonal
    bool has_matrix_ = false; ///< H_ and the solver are those of dt_ and fixed_
};

} // namespace toile
