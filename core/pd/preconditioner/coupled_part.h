#pragma once

#include <vector>

#include "core/linear/block_matrix.h"
#include "core/pd/energy/frozen_hessian.h"

namespace toile {

/// Terms of dH, with the weights of fixed vertices zero.
std::vector<FrozenTerm> free_terms(const FrozenHessian& dH, View<const unsigned char> fixed);

/// Splitting of D + dH into the vertices that terms couple with each other and the rest, which is block
/// diagonal.
struct CoupledPart {
    std::vector<int> vertices; ///< coupled vertices, ascending
    BlockMatrix matrix;        ///< D + dH among them [N/m]
    std::vector<Mat3> blocks;  ///< [all vertices] diagonal blocks of dH [N/m]

    CoupledPart() = default;

    /// @param terms  of free_terms()
    /// @param D      [all vertices] [N/m]
    CoupledPart(const std::vector<FrozenTerm>& terms, View<const double> D);
};

} // namespace toile
