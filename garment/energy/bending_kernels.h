#pragma once

#include "core/backend/types.h"
#include "core/linear/sliced_rows.h"

namespace toile {

/// Bending at vertex i: row i of K times the positions.
///
/// Rows of K sum to zero, so differences to the own vertex replace positions: no rounding far from the
/// origin.
struct BendVertex {
    View<const int> first;    ///< [vertices + 1] entries of K's rows
    View<const int> column;   ///< [entries]
    View<const double> value; ///< [entries] [N/m]
    View<const Vec3> x;       ///< [vertices] [m]

    /// Its gradient [N].
    TOILE_HD Vec3 gradient(int i) const
    {
        const Vec3 here = x[i];
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[i]; k < first[i + 1]; ++k)
            sum += value[k] * (x[column[k]] - here);
        return sum;
    }

    /// Its share of the energy 1/2 x^T K x [J].
    TOILE_HD double energy(int i, const Vec3& gradient) const { return 0.5 * x[i].dot(gradient); }
};

/// BendVertex for a GPU, where bandwidth is short, by a team of threads: rows in slices, their entries in
/// single precision.
struct BendByTeam {
    static constexpr int kAtOnce = 6; ///< entries of a thread: all of most rows, which have some 23

    View<const int> first;        ///< [slices + 1] of SlicedRows; vertices behind them do not bend
    View<const RowEntry> entries; ///< of K [N/m]
    View<const Vec3> x;           ///< [vertices] [m]

    /// Of a vertex: what a thread finds, or all.
    struct Share {
        Vec3 gradient; ///< [N]
        double energy; ///< [J]
    };
    template <typename Team>
    TOILE_HD Share of_thread(int i, const Team& team) const
    {
        const int slice = i / SlicedRows::kRows;
        if (slice + 1 >= first.size())
            return {Vec3(0.0, 0.0, 0.0), 0.0};
        const int end = first[slice + 1];
        const int begin = first[slice] + i % SlicedRows::kRows * SlicedRows::kThreads + team.thread;
        const Vec3 here = x[i];
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = begin; k < end; k += kAtOnce * kWarp)
            for (const RowEntry& entry : entries_from<kAtOnce>(entries, i, k, end))
                sum += double(entry.value) * (x[entry.column] - here);
        return {sum, 0.5 * here.dot(sum)};
    }

    template <typename Team>
    TOILE_HD static Share of_all(const Team& team, const Share& own)
    {
        Share all{own.gradient, team.sum(1, own.energy)}; // where digits cancel, before they are dropped
        for (int a = 0; a < 3; ++a)
            all.gradient[a] = double(team.sum(1, float(own.gradient[a])));
        return all;
    }
};

} // namespace toile
