#pragma once

#include <memory>
#include <vector>

#include "core/linear/global_solver.h"

namespace toile {

/// Global solver for several cloths that are stepped together. H is block-diagonal, and every block keeps the
/// solver that its cloth would have alone, so equal cloths still share factors and tables.
class BlockDiagonalSolver : public GlobalSolver {
public:
    /// Size of a block of H, in ascending order of rows, and its solver.
    struct Block {
        int size;
        std::unique_ptr<GlobalSolver> solver;
    };

    explicit BlockDiagonalSolver(std::vector<Block> blocks);

    /// @throws InvalidInput if an entry of H lies outside the blocks
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void begin_step() override;
    void solve(View<const Vec3> b, View<Vec3> x) const override;
    bool is_symmetric() const override;

private:
    struct Part {
        int first, size;
        std::unique_ptr<GlobalSolver> solver;
    };
    std::vector<Part> parts_;
};

} // namespace toile
