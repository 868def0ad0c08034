#pragma once

#include "core/compute/types.h"

namespace toile {

/// Rotation by the length of a rotation vector [rad] about its direction.
Mat3 rotation_from_vector(const Vec3& rotation_vector);

/// Rotation vector of R, of length up to pi [rad].
Vec3 rotation_vector_of(const Mat3& R);

/// Rotation nearest to A. For A = sum_k b_k a_k^T it is the rotation that brings the a_k nearest to the b_k
/// [Kabsch 1976].
Mat3 nearest_rotation(const Mat3& A);

} // namespace toile
