#pragma once

#include "garment/energy/air/aerodynamics_kernels.h"

namespace toile::garment {

/// No load on vertex v.
struct NoLoad {
    View<Vec3> acceleration; ///< [vertices] out [m/s^2]
    TOILE_HD void operator()(int v) const { acceleration[v] = Vec3(0.0, 0.0, 0.0); }
};

/// Gravity, and damping of a fabric as in a step that is implicit in the velocity.
struct FallDamped {
    Vec3 gravity;       ///< [m/s^2]
    View<const Vec3> v; ///< [vertices] [m/s]
    View<Vec3> into;    ///< [vertices] out: acceleration [m/s^2]

    /// @param damping  [1/s]
    /// @param dt       [s]
    /// @return fraction of the velocity lost per time [1/s]
    TOILE_HD static double decay(double damping, double dt) { return damping / (1.0 + dt * damping); }

    TOILE_HD void at(int i, double decay) const { into[i] = gravity - decay * v[i]; }
};

/// All loads of vertex i of several cloths, as a GPU evaluates them.
struct LoadVertex {
    FallDamped fall;
    View<const int> cloth;      ///< [vertices] -1: no cloth
    View<const double> damping; ///< [cloths] [1/s]
    bool has_air;
    AccelerateByDrag drag;

    TOILE_HD void operator()(int i) const
    {
        fall.at(i, cloth[i] < 0 ? 0.0 : FallDamped::decay(damping[cloth[i]], drag.dt));
        if (has_air)
            drag(i);
    }
};

} // namespace toile::garment
