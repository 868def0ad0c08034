#pragma once

#include <cmath>
#include <vector>

#include "core/linear/cholesky.h"
#include "core/linear/global_solver.h"
#include "core/linear/pcg.h"
#include "tests/core/linear/matrices.h"
#include "tests/support/contraction.h"

/// Systems for approximate global solvers, and the error of one application.
namespace toile::test {

using Field = std::vector<Vec3>;

/// A matrix with some vertices fixed.
struct Problem {
    SparseMatrix H;
    std::vector<unsigned char> fixed;

    int size() const { return int(fixed.size()); }

    /// Random load, zero at fixed vertices.
    Field load(unsigned seed) const
    {
        Field b = random_field(size(), seed);
        for (int i = 0; i < size(); ++i)
            if (fixed[i])
                b[i].setZero();
        return b;
    }
    Field times(const Field& x) const { return as_field(H * as_matrix(x)); }
};

inline Problem with_fixed(const SparseMatrix& H, const std::vector<int>& fixed)
{
    Problem problem{H, {}};
    problem.fixed.assign(problem.H.rows(), 0);
    for (const int i : fixed) {
        problem.fixed[i] = 1;
        isolate(problem.H, i);
    }
    return problem;
}

/// Sheet of 71 x 71 vertices on two pins whose stretch waves travel 40 edges in a time step.
inline Problem stiff_sheet() { return with_fixed(cloth_matrix(71, 71, 40.0), {0, 70}); }

inline Field solve(const GlobalSolver& solver, const Field& b)
{
    Field x(b.size(), Vec3::Constant(-1.0));
    solver.solve(b, x);
    return x;
}

inline Field difference(const Field& a, const Field& b) { return as_field(as_matrix(a) - as_matrix(b)); }

inline double energy_norm(const Problem& problem, const Field& x)
{
    return std::sqrt(dot(x, problem.times(x)));
}

/// |x - H^-1 b| / |H^-1 b| in the norm of H.
inline double energy_error(const Problem& problem, const Field& b, const Field& x)
{
    Field exact(b.size());
    Cholesky(problem.H).solve(b, exact);
    return energy_norm(problem, difference(x, exact)) / energy_norm(problem, exact);
}

/// Spectral radius of the iteration x += S (b - H x).
inline double contraction(const Problem& problem, const GlobalSolver& solver)
{
    return contraction(solver, problem.H, problem.load(3), 30);
}

/// Iterations of conjugate gradients around the solver until |r| / |b| <= tolerance, from white noise.
inline int pcg_iterations(const Problem& problem, const GlobalSolver& solver, double tolerance)
{
    const Field b = problem.load(5);
    Field x(b.size());
    const auto multiply = [&](View<const Vec3> p, View<Vec3> out) {
        for (int i = 0; i < p.size(); ++i)
            out[i] = row_times(problem.H, i, p);
    };
    const auto precondition = [&](View<const Vec3> r, View<Vec3> z) { solver.solve(r, z); };
    return Pcg().solve(multiply, precondition, b, x, {tolerance, 2000, !solver.is_symmetric()}).iterations;
}

} // namespace toile::test
