#pragma once

#include "core/backend/types.h"
#include "core/backend/unroll.h"

namespace toile {

/// Bending at vertex i: row i of K times the positions.
///
/// Rows of K sum to zero, so differences to the own vertex replace positions: no rounding far from the
/// origin.
/// @tparam Number  of K's entries; float is as good to a GPU, whose bandwidth it saves
template <typename Number>
struct BendVertex {
    View<const int> first;    ///< [vertices + 1] entries of K's rows
    View<const int> column;   ///< [entries]
    View<const Number> value; ///< [entries] [N/m]
    View<const Vec3> x;       ///< [vertices] [m]

    /// What every stride-th entry from `begin` on adds to its gradient [N].
    TOILE_HD Vec3 gradient(int i, int begin, int stride) const
    {
        const Vec3 here = x[i];
        Vec3 sum(0.0, 0.0, 0.0);
        TOILE_UNROLL(4)
        for (int k = first[i] + begin; k < first[i + 1]; k += stride)
            sum += double(value[k]) * (x[column[k]] - here);
        return sum;
    }

    /// Its share of the energy 1/2 x^T K x [J].
    TOILE_HD double energy(int i, const Vec3& gradient) const { return 0.5 * x[i].dot(gradient); }
};

/// Bending at vertex i by a team of threads.
struct AddBending {
    BendVertex<float> bend;
    View<Vec3> gradient; ///< [vertices] added to [N]
    View<double> energy; ///< [vertices] added to [J]

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_own) const
    {
        Vec3 sum = bend.gradient(i, team.thread, Team::kThreads);
        for (int a = 0; a < 3; ++a)
            sum[a] = team.sum(1, sum[a]);
        if (team.thread > 0 || !is_own)
            return;
        gradient[i] += sum;
        energy[i] += bend.energy(i, sum);
    }
};

} // namespace toile
