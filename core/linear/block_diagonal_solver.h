#pragma once

#include <memory>
#include <vector>

#include "core/linear/global_solver.h"

namespace toile {

/// Global solver for several bodies that are stepped together. H is block-diagonal, and every block keeps the
/// solver that its body would have alone, so equal bodies still share factors and tables.
class BlockDiagonalSolver : public GlobalSolver {
public:
    /// Rows of H that belong together, ascending, and their solver. Every row is of one block.
    struct Block {
        std::vector<int> rows;
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
        std::vector<int> rows;
        std::unique_ptr<GlobalSolver> solver;
        mutable std::vector<Vec3> of_rows; ///< scratch of solve(), empty if the rows follow each other
    };
    std::vector<Part> parts_;
};

} // namespace toile
