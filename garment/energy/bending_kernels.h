#pragma once

#include "core/backend/types.h"

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
    View<Vec3> gradient;      ///< [vertices] added to [N]

    /// @return the vertex' share of the energy [J]
    TOILE_HD double operator()(int i) const
    {
        const Vec3 here = x[i];
        Vec3 force(0.0, 0.0, 0.0);
        double energy = 0.0;
        for (int k = first[i]; k < first[i + 1]; ++k) {
            const Vec3 difference = x[column[k]] - here;
            force += value[k] * difference;
            energy -= 0.25 * value[k] * difference.squaredNorm();
        }
        gradient[i] += force;
        return energy;
    }
};

/// The same, its energy added to the vertex' share.
struct AddBending {
    BendVertex bend;
    View<double> energy; ///< [vertices] [J]

    TOILE_HD void operator()(int i) const { energy[i] += bend(i); }
};

} // namespace toile
