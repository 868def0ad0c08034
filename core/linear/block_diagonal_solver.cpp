#include "core/linear/block_diagonal_solver.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile {

BlockDiagonalSolver::BlockDiagonalSolver(std::vector<Block> blocks)
{
    for (Block& block : blocks) {
        const bool is_range =
            block.rows.empty() || block.rows.back() - block.rows.front() + 1 == int(block.rows.size());
        const size_t scratch = is_range ? 0 : block.rows.size();
        parts_.push_back({std::move(block.rows), std::move(block.solver), std::vector<Vec3>(scratch)});
    }
}

void BlockDiagonalSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    std::vector<unsigned char> of_rows;
    for (const Part& part : parts_) {
        of_rows.clear();
        for (const int row : part.rows)
            of_rows.push_back(fixed[row]);
        part.solver->update(diagonal_block(H, part.rows), of_rows);
    }
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
        if (const int count = int(part.rows.size()); part.of_rows.empty() && count > 0) {
            part.solver->solve(b.subview(part.rows.front(), count), x.subview(part.rows.front(), count));
            return;
        }
        for (size_t k = 0; k < part.rows.size(); ++k)
            part.of_rows[k] = b[part.rows[k]];
        part.solver->solve(part.of_rows, part.of_rows);
        for (size_t k = 0; k < part.rows.size(); ++k)
            x[part.rows[k]] = part.of_rows[k];
    });
}

bool BlockDiagonalSolver::is_symmetric() const
{
    return std::all_of(parts_.begin(), parts_.end(),
                       [](const Part& part) { return part.solver->is_symmetric(); });
}

} // namespace toile
