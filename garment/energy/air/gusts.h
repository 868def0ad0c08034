#pragma once

#include <cstdint>
#include <vector>

#include "garment/energy/air/gusts_kernels.h"

namespace toile::garment {

/// Turbulence of a steady wind: the deviation of the air's velocity from its mean, in space and time.
///
///   u'(x, t) = sum_m a_m e_m cos(k_m . (x - U t) + w_m t + p_m),   e_m . k_m = 0     [Kraichnan 1970]
///
/// U is the mean velocity that advects the eddies [Taylor 1938]. Each e_m is orthogonal to k_m, so every mode
/// is free of divergence. Each octave of wave numbers has three modes with orthogonal k_m and orthogonal e_m,
/// rotated at random together, so that all components have exactly the same variance. The amplitudes follow
/// Kolmogorov's k^(-5/3). Each eddy also oscillates at frequency w_m [Fung et al. 1992]; otherwise modes
/// across the wind would stand still. The result depends on position, time and seed only.
class Gusts {
public:
    struct Settings {
        /// [-] Standard deviation of each velocity component over the mean speed (turbulence intensity).
        double intensity = 0.0;
        double longest = 4.0; ///< [m] wavelength of the largest eddies; larger ones would act as a mean wind
        int octaves = 5;      ///< halvings of the wavelength, the longest included
        std::uint64_t seed = 0;
    };

    /// @param mean  U [m/s]; without a mean wind there are no gusts
    Gusts(const Vec3& mean, const Settings& settings);

    /// True if the air deviates at all; otherwise callers skip the stage.
    bool are_active() const { return !modes_.empty(); }

    /// u' at a point [m] and time [s], in [m/s].
    Vec3 at(const Vec3& x, double t) const { return gust_at(modes_, x, t); }

    /// u' at every vertex. O(vertices * octaves); stage "garment/gusts".
    void sample(View<const Vec3> x, double t, View<Vec3> out) const;

    View<const GustMode> modes() const { return modes_; }

private:
    std::vector<GustMode> modes_;
};

} // namespace toile::garment
