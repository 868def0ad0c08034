#pragma once

#include "core/compute/types.h"
#include "core/linear/sliced_rows.h"

namespace toile::garment {

/// Bending at vertex i: row i of K times the positions.
///
/// Rows of K sum to zero, so differences to vertex i replace positions. This avoids rounding far from the
/// origin.
struct BendVertex {
    View<const int> first;    ///< [vertices + 1] entries of K's rows
    View<const int> column;   ///< [entries]
    View<const double> value; ///< [entries] [N/m]
    View<const Vec3> x;       ///< [vertices] [m]

    /// Gradient at vertex i [N].
    TOILE_HD Vec3 gradient(int i) const
    {
        const Vec3 here = x[i];
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[i]; k < first[i + 1]; ++k)
            sum += value[k] * (x[column[k]] - here);
        return sum;
    }

    /// Contribution of vertex i to the energy 1/2 x^T K x [J].
    TOILE_HD double energy(int i, const Vec3& gradient) const { return 0.5 * x[i].dot(gradient); }
};

/// BendVertex for a GPU, by a team of threads: rows in slices, their entries in single precision to save
/// bandwidth.
struct BendByTeam {
    static constexpr int kAtOnce = 6; ///< entries per thread: covers most rows, which have about 23

    View<const int> first;        ///< [slices + 1] of SlicedRows; vertices beyond them do not bend
    View<const RowEntry> entries; ///< of K [N/m]
    View<const Vec3> x;           ///< [vertices] [m]

    /// Result at a vertex: partial sum of one thread, or the total.
    struct Partial {
        Vec3 gradient; ///< [N]
        double energy; ///< [J]
    };
    template <typename Team>
    TOILE_HD Partial of_thread(int i, const Team& team) const
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
    TOILE_HD static Partial of_all(const Team& team, const Partial& local)
    {
        Partial all{local.gradient,
                    team.sum(1, local.energy)}; // digits cancel here, so sum before rounding to float
        for (int a = 0; a < 3; ++a)
            all.gradient[a] = double(team.sum(1, float(local.gradient[a])));
        return all;
    }
};

} // namespace toile::garment
