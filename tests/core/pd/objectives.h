#pragma once

#include <algorithm>

#include "core/linear/cholesky.h"
#include "core/linear/field.h"
#include "core/pd/energy/objective.h"
#include "tests/core/linear/matrices.h"

/// Small objectives for the tests of all outer methods.
namespace toile::test {

inline void copy(View<const Vec3> from, View<Vec3> to) { std::copy(from.begin(), from.end(), to.begin()); }

/// Objective without an inverse Hessian; counts the calls of the solver.
class Counting : public Objective {
public:
    void precondition(View<const Vec3> g, View<Vec3> z) override { copy(g, z); }
    void accept(View<const Vec3>) override { ++accepted; }

    int accepted = 0, evaluated = 0;
};

/// 1/2 (x - c)^T A (x - c) with the exact inverse.
class Quadratic : public Counting {
public:
    double evaluate(View<const Vec3> x, View<Vec3> gradient) override
    {
        ++evaluated;
        std::vector<Vec3> from_center(center.size());
        for (int i = 0; i < x.size(); ++i)
            from_center[i] = x[i] - center[i];
        for (int i = 0; i < x.size(); ++i)
            gradient[i] = row_times(A, i, from_center);
        return 0.5 * dot(from_center, gradient);
    }
    void precondition(View<const Vec3> g, View<Vec3> z) override { direct.solve(g, z); }

    SparseMatrix A = grid_laplacian(10, 10, 0.1);
    Cholesky direct{A};
    std::vector<Vec3> center = random_field(100, 1);
};

/// Quadratic whose inverse is neither accurate nor symmetric, as quadrature's.
class Unsymmetric : public Quadratic {
public:
    void precondition(View<const Vec3> g, View<Vec3> z) override
    {
        for (int i = 0; i < g.size(); ++i)
            z[i] = 0.2 * g[i] + 0.05 * g[(i + 1) % g.size()];
    }
};

inline double max_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double largest = 0.0;
    for (size_t i = 0; i < a.size(); ++i)
        largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

/// Rosenbrock's valley in each of the pairs (x, y), (y, z) of one vertex: not convex, minimum 0 at (1, 1, 1).
class Valley : public Counting {
public:
    double evaluate(View<const Vec3> x, View<Vec3> gradient) override
    {
        ++evaluated;
        double value = 0.0;
        for (int i = 0; i < x.size(); ++i) {
            gradient[i].setZero();
            for (int k = 0; k < 2; ++k) {
                const double off = x[i][k + 1] - x[i][k] * x[i][k], left = 1.0 - x[i][k];
                value += 100.0 * off * off + left * left;
                gradient[i][k] += -400.0 * off * x[i][k] - 2.0 * left;
                gradient[i][k + 1] += 200.0 * off;
            }
        }
        return value;
    }
};

/// 1/2 |x|^2 for the first evaluations, then a wall at every evaluation; gradients ten times too small.
class Wall : public Counting {
public:
    explicit Wall(int open) : open_(open) {}
    double evaluate(View<const Vec3> x, View<Vec3> gradient) override
    {
        gradient[0] = 0.1 * x[0];
        return evaluated++ < open_ ? 0.5 * x[0].squaredNorm() : 1e3;
    }

private:
    int open_;
};

} // namespace toile::test
