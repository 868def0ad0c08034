#include "core/quadrature/tables/quadrature_tables.h"

#include <optional>

#include "core/base/error.h"
#include "core/linear/cholesky.h"
#include "core/linear/shared_factor.h"

namespace toile {

std::shared_ptr<QuadratureTables> begin_tables(const TableInput& input)
{
    TOILE_ASSERT(input.H.rows() == input.points.size() && input.fixed.size() == input.points.size());
    std::vector<int> nodes;
    for (int v = 0; v < input.fixed.size(); ++v)
        if (!input.fixed[v])
            nodes.push_back(v);
    return std::make_shared<QuadratureTables>(input.points, std::move(nodes), input.settings.extent);
}

void build_kernel(const TableInput& input, const BuildProgress& progress, QuadratureTables& tables)
{
    const std::shared_ptr<const SupernodalFactor> factor =
        shared_factor(input.H, [&] { return Cholesky(input.H).shared_factor(); });
    const Eigen::VectorXd diagonal = input.H.diagonal();
    std::optional<KernelTable> kernel = build_kernel_table(*factor, {diagonal.data(), int(diagonal.size())},
                                                           tables.basis, input.settings.kernel, progress);
    if (!kernel)
        throw Cancelled("building the quadrature tables was cancelled");
    tables.kernel = std::move(*kernel);
}

std::shared_ptr<const QuadratureTables> build_tables(const TableInput& input, const BuildProgress& progress)
{
    const std::shared_ptr<QuadratureTables> tables = begin_tables(input);
    build_kernel(input, progress, *tables);
    return tables;
}

} // namespace toile
