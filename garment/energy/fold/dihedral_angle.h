#pragma once

#include <array>

#include <Eigen/Core>

#include "core/compute/types.h"

namespace toile::garment {

/// Corners of an edge (v0, v1) with the triangles (v0, v1, a) and (v1, v0, b) [m].
//
//         a
//       /  \          the angle is positive where the outer sides, the normals' ones, turn to each other
//      v0---v1
//       \  /
//         b
struct HingeCorners {
    Vec3 v0, v1, a, b;
};

/// Angle between the triangles of an edge [rad]: 0 flat, in (-pi, pi]. Accurate everywhere, and where a
/// triangle has collapsed 0.
double dihedral_angle(const HingeCorners& x);

/// Derivatives of the dihedral angle by the corners, in their order.
struct DihedralDerivatives {
    Eigen::Matrix<double, 12, 1> gradient = Eigen::Matrix<double, 12, 1>::Zero();  ///< [1/m]
    Eigen::Matrix<double, 12, 12> hessian = Eigen::Matrix<double, 12, 12>::Zero(); ///< [1/m^2] symmetric
};

/// Gradient of the dihedral angle: with the unit normals n_a, n_b and the heights h_a, h_b over the edge,
///
///   by a: n_a / h_a,   by b: n_b / h_b,   by v0 and v1: what balances force and torque [Bridson et al. 2003]
///
/// A collapsed triangle has none.
std::array<Vec3, 4> dihedral_gradient(const HingeCorners& x);

/// The gradient with its derivative, the sum of one term for each triangle [Tamstorf & Grinspun 2013]. Both
/// are free of divisions by the sine of the angle.
DihedralDerivatives dihedral_derivatives(const HingeCorners& x);

} // namespace toile::garment
