#pragma once

#include <vector>

#include "core/backend/cuda/array.h"
#include "core/linear/sliced_rows.h"
#include "core/pd/device/device_energy.h"
#include "garment/energy/membrane_kernels.h"
#include "garment/energy/rest_shape.h"

namespace toile {

/// Membrane and bending of all cloths of a body on a GPU: a kernel over triangles, and one that gathers at
/// vertices and multiplies positions by bending's matrix there.
class DeviceElasticity : public DeviceEnergy {
public:
    explicit DeviceElasticity(const CudaSpace& space);

    /// Adds the membrane of a cloth after those before it.
    /// @param first_vertex  of the cloth among the body's
    void add_membrane(const RestShape& rest, const MembraneWeights& weights, int first_vertex);

    /// Adds the bending of a cloth after those before it, whose membrane is here or will be.
    /// @param K  of Bending::matrix()
    void add_bending(const SparseMatrix& K, int first_vertex);

    int share_count() const override { return triangles_.size(); }
    void add_gradient(const DeviceEvaluation& at) override;

private:
    /// What is on the device, of all cloths so far.
    struct OnHost {
        std::vector<Triangle> triangles;
        std::vector<Mat2> rest_inv;
        std::vector<double> area;
        std::vector<int> fabric;
        std::vector<MembraneWeights> weights;
        std::vector<int> first_corner{0}, corners;
        std::vector<int> bending_first{0}, bending_column; ///< rows
        std::vector<float> bending_value;
    };
    void upload(); ///< the membrane

    const CudaSpace& space_;
    OnHost host_;
    DeviceArray<Triangle> triangles_;
    DeviceArray<Mat2> rest_inv_;
    DeviceArray<double> area_;
    DeviceArray<int> fabric_;
    DeviceArray<MembraneWeights> weights_;
    DeviceArray<int> first_corner_, corners_;
    DeviceArray<CornerPair> corner_gradient_; ///< [triangles] [N]
    DeviceArray<int> bending_first_;          ///< of SlicedRows
    DeviceArray<RowEntry> bending_entries_;
};

} // namespace toile
