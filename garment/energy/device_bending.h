#pragma once

#include <vector>

#include "core/backend/cuda/array.h"
#include "core/linear/sliced_rows.h"
#include "core/linear/sparse_matrix.h"
#include "core/pd/device/device_energy.h"

namespace toile {

/// Bending of all cloths of a body on a GPU: a product with a sparse matrix.
class DeviceBending : public DeviceEnergy {
public:
    explicit DeviceBending(const CudaSpace& space);

    /// Adds a cloth after those before it.
    /// @param K  of Bending::matrix()
    /// @param first_vertex  of the cloth among the body's
    void add(const SparseMatrix& K, int first_vertex);

    void add_gradient(const DeviceEvaluation& at) override;

private:
    const CudaSpace& space_;
    std::vector<int> host_first_{0}, host_column_; ///< rows of all cloths so far
    std::vector<float> host_value_;
    DeviceArray<int> first_; ///< of SlicedRows
    DeviceArray<RowEntry> entries_;
};

} // namespace toile
