#pragma once

#include "core/compute/lanes.h"
#include "core/linear/sliced_rows.h"
#include "core/pd/preconditioner/chebyshev.h"

namespace toile::research {

/// Kernels of the baselines' sweeps on a GPU, in single precision.

/// Copies b in single precision; writes zero at fixed vertices.
struct PadFree {
    View<const Vec3> b;
    View<const float> scale; ///< [n] 0 where fixed
    View<PaddedVec3> padded;

    TOILE_HD void operator()(int i) const
    {
        padded[i] = scale[i] == 0.0F ? PaddedVec3(0.0F) : toile::padded(b[i]);
    }
};

/// Copies x in double precision; copies b at fixed vertices.
struct UnpadFree {
    View<const PaddedVec3> padded;
    View<const Vec3> b;
    View<const float> scale; ///< [n] 0 where fixed
    View<Vec3> x;

    TOILE_HD void operator()(int i) const { x[i] = scale[i] == 0.0F ? b[i] : unpadded(padded[i]); }
};

/// Makes the first step, from zero: x = d = gain scale b.
struct FirstSweep {
    float gain;
    View<const float> scale; ///< [n]
    View<const PaddedVec3> b;
    View<PaddedVec3> d, x; ///< out

    TOILE_HD void operator()(int i) const { x[i] = d[i] = (gain * scale[i]) * b[i]; }
};

/// Makes a ChebyshevStep for a vertex, with a team of threads per row: d = momentum d + gain scale (b - A x),
/// next = x + d.
struct SweepRow {
    View<const int> first;        ///< [slices + 1] of SlicedRows
    View<const RowEntry> entries; ///< of A
    float momentum, gain;
    View<const float> scale; ///< [n]
    View<const PaddedVec3> b, x;
    View<PaddedVec3> d, next;

    template <typename Team>
    TOILE_HD void operator()(int i, const Team& team, bool is_in_range) const
    {
        const int slice = i / SlicedRows::kRows, last = first[slice + 1];
        PaddedVec3 product(0.0F);
        for (int k = first[slice] + i % SlicedRows::kRows * SlicedRows::kThreads + team.thread; k < last;
             k += kWarp)
            product += entries[k].value * x[entries[k].column];
        for (int a = 0; a < 3; ++a)
            product.value[a] = team.sum(1, product[a]);
        if (team.thread != 0 || !is_in_range)
            return;
        PaddedVec3 change = momentum * d[i];
        PaddedVec3 residual = b[i];
        residual += -1.0F * product;
        change += (gain * scale[i]) * residual;
        d[i] = change;
        change += x[i];
        next[i] = change;
    }
};

} // namespace toile::research
