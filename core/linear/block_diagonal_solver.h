#pragma once

#include <memory>
#include <vector>

#include "core/linear/global_solver.h"

namespace toile {

/// The global step of several cloths that are stepped together: H is block-diagonal, and every block keeps
/// the solver that its cloth would have alone, so equal cloths go on sharing factors and tables.
class BlockDiagonalSolver : public GlobalSolver {
public:
    /// Rows of H that belong together, in ascending order, and their solver.
    struct Block {
        int size;
        std::unique_ptr<GlobalSolver> solver;
    };

    explicit BlockDiagonalSolver(std::vector<Block> blocks);

    /// @throws InvalidInput where an entry of H lies outside the blocks
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
