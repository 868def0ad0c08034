#pragma once

#include <functional>
#include <memory>

#include "core/linear/sparse_matrix.h"
#include "core/linear/supernodal_factor.h"

namespace toile {

/// Factor of H that equal matrices of this process share: five equal cloths factor once. Freed with its last
/// user. Pattern and values are compared by their hash, bit by bit.
/// @param make  called where nobody has a factor of this H
std::shared_ptr<const SupernodalFactor>
shared_factor(const SparseMatrix& H, const std::function<std::shared_ptr<const SupernodalFactor>()>& make);

} // namespace toile
