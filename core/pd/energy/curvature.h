#pragma once

#include <memory>
#include <vector>

#include "core/pd/energy/energy.h"

namespace toile {

/// True Hessian of a sum of energies: a part that is equal for x, y and z, and blocks. Bending couples two
/// rings of neighbours but is isotropic. Stored as numbers it needs a sixth of the memory of blocks.
class Curvature {
public:
    /// Builds both patterns. O(couplings log couplings).
    Curvature(int vertex_count, std::vector<std::shared_ptr<Energy>> energies);

    /// Evaluates what depends on x [vertices] in the existing pattern.
    void assemble(View<const Vec3> x, Definiteness definiteness);

    const SparseMatrix& isotropic() const { return isotropic_; } ///< [vertices x vertices] [N/m]
    const BlockMatrix& blocks() const { return blocks_; }        ///< [N/m]

private:
    std::vector<std::shared_ptr<Energy>> energies_;
    SparseMatrix isotropic_;
    std::vector<double> constant_; ///< values of isotropic_ that do not depend on x; empty: all of them
    BlockMatrix blocks_;
};

} // namespace toile
