#pragma once

#include "core/compute/types.h"

namespace toile::research {

/// A vertex in the baselines' GPU kernels: two loads of 16 bytes. Positions are in double precision for any
/// type of arithmetic, so that differences of neighbours lose nothing.
struct alignas(16) Particle {
    double x, y, z;  ///< [m]
    double mobility; ///< [1/kg] 0 if fixed

    Particle() = default;
    TOILE_HD Particle(const Vec3& position, double one_over_mass)
        : x(position[0]), y(position[1]), z(position[2]), mobility(one_over_mass)
    {
    }

    TOILE_HD Vec3 position() const { return Vec3(x, y, z); }

    /// Copy of this particle at another position.
    TOILE_HD Particle at(const Vec3& position) const { return Particle(position, mobility); }
};

/// b - a, in the type of the arithmetic [m].
template <typename T>
TOILE_HD Eigen::Matrix<T, 3, 1> difference(const Particle& a, const Particle& b)
{
    return Eigen::Matrix<T, 3, 1>(T(b.x - a.x), T(b.y - a.y), T(b.z - a.z));
}

} // namespace toile::research
