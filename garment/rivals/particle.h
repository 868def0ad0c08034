#pragma once

#include "core/backend/types.h"

namespace toile {

/// A vertex as the rivals' kernels on a GPU know it: two loads of 16 bytes. Places are in double precision
/// whatever the arithmetic, so that differences of neighbours lose nothing.
struct alignas(16) Particle {
    double x, y, z;  ///< [m]
    double mobility; ///< [1/kg] 0 where fixed

    Particle() = default;
    TOILE_HD Particle(const Vec3& place, double one_over_mass)
        : x(place[0]), y(place[1]), z(place[2]), mobility(one_over_mass)
    {
    }

    TOILE_HD Vec3 place() const { return Vec3(x, y, z); }

    /// This one elsewhere.
    TOILE_HD Particle at(const Vec3& place) const { return Particle(place, mobility); }
};

/// b - a, as the arithmetic has it [m].
template <typename T>
TOILE_HD Eigen::Matrix<T, 3, 1> difference(const Particle& a, const Particle& b)
{
    return Eigen::Matrix<T, 3, 1>(T(b.x - a.x), T(b.y - a.y), T(b.z - a.z));
}

} // namespace toile
