#pragma once

#include <cmath>

#include "garment/energy/fold/dihedral_angle.h"

namespace toile::test {

/// Two uneven triangles of centimetres over an edge along y, folded by an angle [rad]: that of b lies in the
/// plane z = 0, and its normal along z.
inline garment::HingeCorners hinge_at(double angle)
{
    const double height = 0.03; // [m] of a
    return {Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.02, 0.0),
            Vec3(-height * std::cos(angle), 0.005, height * std::sin(angle)), Vec3(0.017, 0.022, 0.0)};
}

} // namespace toile::test
