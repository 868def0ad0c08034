#pragma once

#include <functional>
#include <memory>

#include "core/linear/sparse_matrix.h"
#include "core/linear/supernodal_factor.h"

namespace toile {

/// Factor of H, shared by equal matrices of this process: five equal cloths factor once. Freed with its last
/// user. Pattern and values are compared by their hash, bit by bit.
/// @param make  called if no factor of this H is in use
std::shared_ptr<const SupernodalFactor>
shared_factor(const SparseMatrix& H, const std::function<std::shared_ptr<const SupernodalFactor>()>& make);

} // namespace toile
