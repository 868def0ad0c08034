#pragma once

#include <memory>
#include <vector>

#include "core/pd/energy/energy.h"

namespace toile {

/// True Hessian of a sum of energies: a constant part that x, y and z share, and blocks that change with x.
/// Bending couples two rings of neighbours but is constant. Stored as numbers it needs a sixth of the memory
/// of blocks.
class Curvature {
public:
    /// Builds both patterns. O(couplings log couplings).
    Curvature(int vertex_count, std::vector<std::shared_ptr<Energy>> energies);

    /// Evaluates the blocks at x [vertices] in the existing pattern.
    void assemble(View<const Vec3> x, Definiteness definiteness);

    const SparseMatrix& constant() const { return constant_; } ///< [vertices x vertices] [N/m]
    const BlockMatrix& blocks() const { return blocks_; }      ///< [N/m]

private:
    std::vector<std::shared_ptr<Energy>> energies_;
    SparseMatrix constant_;
    BlockMatrix blocks_;
};

} // namespace toile
