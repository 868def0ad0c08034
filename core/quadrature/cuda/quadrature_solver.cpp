#include "core/quadrature/cuda/quadrature_solver.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "core/linear/cholesky.h"
#include "core/linear/shared_factor.h"
#include "core/quadrature/cuda/table_builder.h"

namespace toile {

/// Bodies with equal tables.
struct DeviceQuadratureSolver::Group {
    Hash128 key;
    SparseMatrix H; ///< of one body
    std::vector<unsigned char> fixed;
    const Part* part;                   ///< the first of them
    std::vector<std::vector<int>> rows; ///< [bodies] of the whole matrix
};

DeviceQuadratureSolver::DeviceQuadratureSolver(const CudaSpace& space, std::vector<Part> parts,
                                               std::shared_ptr<TableStore> store, Weights weights)
    : DeviceSolver(space), parts_(std::move(parts)), store_(std::move(store)), weights_(weights)
{
    int next = 0;
    for (Part& part : parts_) {
        if (part.rows.empty())
            part.rows = consecutive_rows(next, int(part.points.size()));
        TOILE_ASSERT(part.rows.size() == part.points.size());
        next = part.rows.back() + 1;
    }
}

void DeviceQuadratureSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    std::vector<Group> groups;
    for (const Part& part : parts_) {
        SparseMatrix block = diagonal_block(H, part.rows);
        std::vector<unsigned char> fixed_rows;
        for (const int row : part.rows)
            fixed_rows.push_back(fixed[row]);
        const Hash128 key = table_key({block, fixed_rows, part.points, part.settings});
        auto known =
            std::find_if(groups.begin(), groups.end(), [&](const Group& group) { return group.key == key; });
        if (known == groups.end()) {
            groups.push_back({key, {}, std::move(fixed_rows), &part, {}});
            known = groups.end() - 1;
            known->H.swap(block);
        }
        known->rows.push_back(part.rows);
    }
    std::vector<DeviceQuadrature> operators;
    operators.reserve(groups.size());
    for (const Group& group : groups)
        operators.push_back(make_operator(group));
    operators_ = std::move(operators);
}

/// Uses tables from memory or disk, else tables built on the device. The latter are not stored: their last
/// bits may differ from the CPU's.
DeviceQuadrature DeviceQuadratureSolver::make_operator(const Group& group) const
{
    const Part& part = *group.part;
    const TableInput input{group.H, group.fixed, part.points, part.settings};
    const Eigen::VectorXd diagonal = group.H.diagonal();
    const View<const double> of_H(diagonal.data(), int(diagonal.size()));
    PackingAccuracy packing;
    if (weights_ == Weights::Bytes)
        packing = {of_H, part.settings.kernel.tolerance};
    if (const auto tables = store_->find(input, part.listener))
        return {space(), *tables, group.rows, packing};

    const std::shared_ptr<const QuadratureTables> tables = begin_tables(input);
    const std::shared_ptr<const SupernodalFactor> factor =
        shared_factor(group.H, [&] { return Cholesky(group.H).shared_factor(); });
    std::optional<DeviceKernelTable> kernel = build_kernel_table(
        space(), *factor, of_H, tables->basis, part.settings.kernel, part.listener.progress);
    if (!kernel)
        throw Cancelled("building the quadrature tables was cancelled");
    return {space(), tables->basis, std::move(*kernel), group.rows, packing};
}

void DeviceQuadratureSolver::solve_on_device(View<const Vec3> b, View<Vec3> x) const
{
    DeviceQuadrature::solve(operators_, b, x);
}

} // namespace toile
