#include "garment/energy/device_bending.h"

#include "core/backend/cuda/teams.cuh"
#include "garment/energy/bending_kernels.h"

namespace toile {

DeviceBending::DeviceBending(const CudaSpace& space)
    : space_(space), first_(space, "bending/first"), entries_(space, "bending/entries")
{
}

void DeviceBending::add(const SparseMatrix& K, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_first_.size()));
    host_first_.resize(first_vertex + 1, int(host_column_.size()));
    for (int row = 0; row < K.outerSize(); ++row) {
        for (SparseMatrix::InnerIterator entry(K, row); entry; ++entry) {
            host_column_.push_back(first_vertex + int(entry.col()));
            host_value_.push_back(float(entry.value()));
        }
        host_first_.push_back(int(host_column_.size()));
    }
    const SlicedRows rows(host_first_, host_column_, host_value_);
    first_.upload(rows.first);
    entries_.upload(rows.entries);
}

void DeviceBending::add_gradient(const DeviceEvaluation& at)
{
    parallel_for_teams<SlicedRows::kThreads>(
        space_, "bending/multiply", int(host_first_.size()) - 1,
        AddBending{first_.view(), entries_.view(), at.x, at.gradient, at.energy});
}

} // namespace toile
