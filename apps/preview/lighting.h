#pragma once

#include <cmath>

#include "apps/preview/camera.h"
#include "core/compute/types.h"

namespace toile::preview {

/// A warm sun as key light, a pale blue sky as fill, the floor's warm reflection from below. The sun rotates
/// with the camera, so every azimuth is lit from the upper left. Light is in units of a white diffuse
/// surface's radiance.
struct Lighting {
    Vec3 to_sun = Vec3::UnitY();       ///< unit
    Vec3 sun = Vec3(2.15, 1.98, 1.72); ///< irradiance of a surface facing it
    double sun_spread = 0.085;         ///< tangent of the sun's half angle: softness of shadows
    Vec3 zenith = Vec3(0.58, 0.66, 0.80);
    Vec3 horizon = Vec3(0.80, 0.80, 0.80);
    Vec3 floor_bounce = Vec3(0.42, 0.39, 0.36); ///< light reflected upwards by an open floor

    /// Puts the sun over the viewer's left shoulder.
    explicit Lighting(const Camera& camera)
    {
        const Vec3 backwards(-camera.forward.x(), 0.0, -camera.forward.z());
        to_sun = (-0.62 * camera.right + 0.92 * Vec3::UnitY() + 0.42 * backwards.normalized()).normalized();
    }

    /// Radiance from a direction: the sky above the horizon, an open floor below it.
    Vec3 from(const Vec3& direction) const
    {
        const double height = direction.y();
        if (height < 0.0)
            return floor_bounce;
        return horizon + std::sqrt(height) * (zenith - horizon);
    }
};

/// Scale of radiance before the tone curve. Albedo 0.5 in sunlight becomes about 0.55; more washes colours
/// out.
inline constexpr double kExposure = 0.36;

/// Display colour of a radiance: a filmic curve that keeps darks open and rolls highlights off.
///
///   c -> c (a c + b) / (c (c a + d) + e)                                           [Narkowicz 2015]
inline Vec3 tone_map(const Vec3& radiance)
{
    constexpr double a = 2.51, b = 0.03, d = 0.59, e = 0.14;
    const Vec3 c = kExposure * radiance;
    return (c.array() * (a * c.array() + b) / (c.array() * (2.43 * c.array() + d) + e)).min(1.0).max(0.0);
}

} // namespace toile::preview
