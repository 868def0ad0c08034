#pragma once

#include "core/compute/types.h"

namespace toile::research {

/// Vertex that a sum reads, with its weight.
struct WeightedVertex {
    int vertex = 0;
    double weight = 0.0;
};

/// Counterpart of a team of threads on a CPU (core/compute/team.h).
struct OneThread {
    static constexpr int kThreads = 1;
    int thread = 0;

    template <typename Number>
    TOILE_HD Number sum(int, Number value) const
    {
        return value;
    }
};

/// Weighted sums over vertices, one for each vertex: the paper's rule, or a sparse matrix.
struct WeightedRows {
    static constexpr int kThreads = 8; ///< threads of a GPU that share a row of the rule

    View<const int> first; ///< [vertices + 1] into entries
    View<const WeightedVertex> entries;

    /// Sum of row i; all threads of the team get it.
    template <typename Team>
    TOILE_HD Vec3 sum(int i, const Team& team, const View<const Vec3>& field) const
    {
        Vec3 result(0.0, 0.0, 0.0);
        const int last = first[i + 1];
        for (int k = first[i] + team.thread; k < last; k += Team::kThreads)
            result += entries[k].weight * field[entries[k].vertex];
        for (int axis = 0; axis < 3; ++axis)
            result[axis] = team.sum(1, result[axis]);
        return result;
    }
};

/// Computes x_i from b by the rule [multilevel quadrature for PD, eq. 7].
struct ApplyRule {
    WeightedRows rule;
    View<const Vec3> b;
    View<Vec3> x; ///< out; not b

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        const Vec3 sum = rule.sum(i, team, b);
        if (team.thread == 0 && is_in_range)
            x[i] = sum;
    }
};

/// Computes the residual r = b - H x.
struct RuleResidual {
    WeightedRows H;
    View<const Vec3> b, x;
    View<Vec3> r; ///< out

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        const Vec3 product = H.sum(i, team, x);
        if (team.thread == 0 && is_in_range)
            r[i] = b[i] - product;
    }
};

/// Applies the rule to the residual: x += rule(r).
struct CorrectByRule {
    WeightedRows rule;
    View<const Vec3> r;
    View<Vec3> x; ///< in, out

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        const Vec3 sum = rule.sum(i, team, r);
        if (team.thread == 0 && is_in_range)
            x[i] += sum;
    }
};

} // namespace toile::research
