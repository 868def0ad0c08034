#include "core/linear/block_diagonal_solver.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile {

BlockDiagonalSolver::BlockDiagonalSolver(std::vector<Block> blocks)
{
    int first = 0;
    for (Block& block : blocks) {
        parts_.push_back({first, block.size, std::move(block.solver)});
        first += block.size;
    }
}

void BlockDiagonalSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    for (const Part& part : parts_)
        part.solver->update(diagonal_block(H, part.first, part.size), fixed.subview(part.first, part.size));
}

void BlockDiagonalSolver::begin_step()
{
    for (const Part& part : parts_)
        part.solver->begin_step();
}

void BlockDiagonalSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    parallel_tasks(kCpu, int(parts_.size()), [&](int i) {
        const Part& part = parts_[i];
        part.solver->solve(b.subview(part.first, part.size), x.subview(part.first, part.size));
    });
}

bool BlockDiagonalSolver::is_symmetric() const
{
    return std::all_of(parts_.begin(), parts_.end(),
                       [](const Part& part) { return part.solver->is_symmetric(); });
}

} // namespace toile
