#pragma once

#include <cmath>

#include "core/compute/types.h"

namespace toile::garment {

/// One mode of Gusts.
struct GustMode {
    Vec3 wave;        ///< k_m [rad/m]
    Vec3 velocity;    ///< a_m e_m [m/s]
    double frequency; ///< w_m - k_m . U [rad/s]
    double phase;     ///< p_m [rad]
};

/// u' at point x [m] and time t [s], in [m/s].
TOILE_HD inline Vec3 gust_at(View<const GustMode> modes, const Vec3& x, double t)
{
    Vec3 sum = Vec3::Zero();
    for (int m = 0; m < modes.size(); ++m)
        sum += std::cos(modes[m].wave.dot(x) + modes[m].frequency * t + modes[m].phase) * modes[m].velocity;
    return sum;
}

/// u' at vertex i.
struct SampleGusts {
    View<const GustMode> modes;
    View<const Vec3> x; ///< [vertices] [m]
    double t;           ///< [s]
    View<Vec3> gusts;   ///< [vertices] out [m/s]

    TOILE_HD void operator()(int i) const { gusts[i] = gust_at(modes, x[i], t); }
};

} // namespace toile::garment
