#include "core/linear/cuda/inverse_columns.h"

#include "core/compute/cuda/tiles.cuh"

namespace toile {

DeviceInverseColumns::DeviceInverseColumns(const CudaSpace& space, const InvertedFactor& factor)
    : space_(space), factor_(factor), row_of_(factor.size()), column_tiles_(tiles_of_columns(factor)),
      nodes_(space, "inverse/nodes"), rows_(space, "inverse/rows"),
      first_child_(space, "inverse/first_child"), children_(space, "inverse/children"),
      front_of_(space, "inverse/front_of"), unit_row_(space, "inverse/unit_row"),
      tiles_(space, "inverse/tiles"), front_tiles_(space, "inverse/front_tiles"),
      values_(space, "inverse/values"), x_(space, "inverse/columns"), fronts_(space, "inverse/fronts"),
      solved_(space, "inverse/solved")
{
    for (int k = 0; k < factor.size(); ++k)
        row_of_[factor.permutation()[k]] = k;
    nodes_.upload(factor.nodes());
    rows_.upload(factor.rows());
    values_.upload(factor.values());
    first_child_.upload(factor.first_child());
    children_.upload(factor.children());
    tiles_.upload(column_tiles_.tiles);
    view_ = {nodes_.view(), rows_.view(), values_.view(), first_child_.view(), children_.view()};
}

std::size_t DeviceInverseColumns::fixed_bytes(const InvertedFactor& factor)
{
    return factor.values().size() * sizeof(double) + factor.rows().size() * sizeof(int) +
           factor.nodes().size() * (sizeof(InvertedNode) + 3 * sizeof(int)) +
           std::size_t(factor.size()) * sizeof(RowTile);
}

std::size_t DeviceInverseColumns::column_bytes(const InvertedFactor& factor, int front_rows)
{
    return (std::size_t(factor.size()) + 2 * std::size_t(front_rows)) * sizeof(double);
}

void DeviceInverseColumns::reserve(int columns, int front_rows)
{
    TOILE_ASSERT(columns % kColumnMultiple == 0);
    stride_ = columns;
    x_.resize(factor_.size() * stride_);
    fronts_.resize(front_rows * stride_);
    solved_.resize(front_rows * stride_);
}

void DeviceInverseColumns::solve(View<const int> targets)
{
    TOILE_ASSERT(targets.size() <= stride_);
    const int columns = block_count(targets.size(), kColumnMultiple) * kColumnMultiple;
    upload_plan(targets);
    for (int level = int(plan_.tiles.first.size()) - 2; level >= 0; --level)
        eliminate(level, columns);
    for (int level = 0; level < factor_.level_count(); ++level)
        substitute_back(level, columns);
}

void DeviceInverseColumns::upload_plan(View<const int> targets)
{
    const int columns = block_count(targets.size(), kColumnMultiple) * kColumnMultiple;
    unit_row_host_.assign(columns, -1);
    for (int c = 0; c < targets.size(); ++c)
        if (targets[c] >= 0)
            unit_row_host_[c] = row_of_[targets[c]];
    plan_ = plan_forward(factor_, unit_row_host_);
    TOILE_ASSERT(plan_.front_rows * stride_ <= fronts_.size());
    unit_row_.upload(unit_row_host_);
    front_of_.upload(plan_.front_of);
    front_tiles_.upload(plan_.tiles.tiles);
}

void DeviceInverseColumns::eliminate(int level, int columns)
{
    const std::vector<int>& first = plan_.tiles.first;
    const View<const RowTile> tiles =
        front_tiles_.view().subview(first[level], first[level + 1] - first[level]);
    const ColumnBlock fronts{fronts_.view().data(), stride_}, solved{solved_.view().data(), stride_};
    parallel_for(space_, "inverse/assemble", tiles.size() * RowTile::kRows * columns,
                 AssembleFronts{view_, tiles, front_of_.view(), unit_row_.view(), fronts});
    const int column_tiles = columns / ProductTile::kColumns;
    parallel_tiles(space_, "inverse/eliminate", tiles.size() * column_tiles,
                   EliminateNodes{{}, view_, tiles, front_of_.view(), fronts, solved, column_tiles});
}

void DeviceInverseColumns::substitute_back(int level, int columns)
{
    const std::vector<int>& first = column_tiles_.first;
    const View<const RowTile> tiles = tiles_.view().subview(first[level], first[level + 1] - first[level]);
    const ColumnBlock solved{solved_.view().data(), stride_};
    const int column_tiles = columns / ProductTile::kColumns;
    parallel_tiles(space_, "inverse/back", tiles.size() * column_tiles,
                   SubstituteBack{{}, view_, tiles, front_of_.view(), solved, rows(), column_tiles});
}

} // namespace toile
