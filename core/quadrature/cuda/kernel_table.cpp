#include "core/quadrature/cuda/kernel_table.h"

namespace toile {

DeviceKernelTable::DeviceKernelTable(const CudaSpace& space, int table_rank, int leaf_count)
    : rank(table_rank), near_first(space, "quadrature/near_first", leaf_count + 1),
      near_leaf(space, "quadrature/near_leaf"), near_weights(space, "quadrature/near_weights"),
      far_first(space, "quadrature/far_first", leaf_count + 1), far_cluster(space, "quadrature/far_cluster"),
      far_weights(space, "quadrature/far_weights")
{
    near_first.fill_zero();
    far_first.fill_zero();
}

DeviceKernelTable::DeviceKernelTable(const CudaSpace& space, const KernelTable& table)
    : DeviceKernelTable(space, table.rank, int(table.near_first.size()) - 1)
{
    near_first.upload(table.near_first);
    near_leaf.upload(table.near_leaf);
    near_weights.upload(table.near_weights);
    far_first.upload(table.far_first);
    far_cluster.upload(table.far_cluster);
    far_weights.upload(table.far_weights);
}

KernelTable DeviceKernelTable::downloaded() const
{
    KernelTable table;
    table.rank = rank;
    table.near_first = near_first.downloaded();
    table.near_leaf = near_leaf.downloaded();
    table.near_weights = near_weights.downloaded();
    table.far_first = far_first.downloaded();
    table.far_cluster = far_cluster.downloaded();
    table.far_weights = far_weights.downloaded();
    return table;
}

std::size_t DeviceKernelTable::bytes() const
{
    return (std::size_t(near_weights.size()) + far_weights.size()) * sizeof(float) +
           (std::size_t(near_first.size()) + near_leaf.size() + far_first.size() + far_cluster.size()) *
               sizeof(int);
}

} // namespace toile
