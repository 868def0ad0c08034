#include "garment/energy/device_bending.h"

#include "core/backend/cuda/teams.cuh"
#include "garment/energy/bending_kernels.h"

namespace toile {

namespace {

/// Threads of a row, which has some 23 entries.
constexpr int kTeam = 8;

} // namespace

DeviceBending::DeviceBending(const CudaSpace& space)
    : space_(space), first_(space, "bending/first"), column_(space, "bending/column"),
      value_(space, "bending/value")
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
    first_.upload(host_first_);
    column_.upload(host_column_);
    value_.upload(host_value_);
}

void DeviceBending::add_gradient(const DeviceEvaluation& at)
{
    const BendVertex<float> bend{first_.view(), column_.view(), value_.view(), at.x};
    parallel_for_teams<kTeam>(space_, "bending/multiply", first_.size() - 1,
                              AddBending{bend, at.gradient, at.energy});
}

} // namespace toile
