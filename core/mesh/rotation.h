#pragma once

#include "core/backend/types.h"

namespace toile {

/// The rotation by |turn| [rad] about the direction of turn.
Mat3 turned_by(const Vec3& turn);

/// The turn of a rotation, as a vector of length up to pi [rad].
Vec3 turn_of(const Mat3& R);

/// The rotation nearest to A; of A = sum_k b_k a_k^T the one that brings the a_k nearest to the b_k [Kabsch
/// 1976].
Mat3 nearest_rotation(const Mat3& A);

} // namespace toile
