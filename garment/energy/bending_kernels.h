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
struct AddBending {
    static constexpr int kAtOnce = 6; ///< entries of a thread: all of most rows, which have some 23

    View<const int> first;        ///< [slices + 1] of SlicedRows
    View<const RowEntry> entries; ///< of K [N/m]
    View<const Vec3> x;           ///< [vertices] [m]
    View<Vec3> gradient;          ///< [vertices] added to [N]
    View<double> energy;          ///< [vertices] added to [J]

    /// Where a thread's entries are, and the first of them: what no launch changes.
    struct Early {
        int begin, end;
        std::array<RowEntry, kAtOnce> some;
    };
    template <typename Team>
    TOILE_HD Early early(int i, const Team& team, bool) const
    {
        const int slice = i / SlicedRows::kRows, end = first[slice + 1];
        const int begin = first[slice] + i % SlicedRows::kRows * SlicedRows::kThreads + team.thread;
        return {begin, end, entries_from<kAtOnce>(entries, i, begin, end)};
    }

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_own) const
    {
        (*this)(i, team, is_own, early(i, team, is_own));
    }
    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_own, const Early& own_entries) const
    {
        const bool writes = team.thread == 0 && is_own;
        const Vec3 here = x[i], before = writes ? gradient[i] : Vec3(0.0, 0.0, 0.0);
        const double energy_before = writes ? energy[i] : 0.0;
        Vec3 sum(0.0, 0.0, 0.0);
        if (own_entries.begin < own_entries.end)
            add_some(own_entries.some, here, sum);
        for (int k = own_entries.begin + kAtOnce * kWarp; k < own_entries.end; k += kAtOnce * kWarp)
            add_some(entries_from<kAtOnce>(entries, i, k, own_entries.end), here, sum);

        const double own = team.sum(1, 0.5 * here.dot(sum)); // where digits cancel, before they are dropped
        for (int a = 0; a < 3; ++a)
            sum[a] = double(team.sum(1, float(sum[a])));
        if (!writes)
            return;
        gradient[i] = before + sum;
        energy[i] = energy_before + own;
    }

private:
    TOILE_HD void add_some(const std::array<RowEntry, kAtOnce>& some, const Vec3& here, Vec3& sum) const
    {
        for (const RowEntry& entry : some)
            sum += double(entry.value) * (x[entry.column] - here);
    }
};

} // namespace toile
