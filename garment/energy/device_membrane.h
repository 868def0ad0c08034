#pragma once

#include <vector>

#include "core/backend/cuda/array.h"
#include "core/pd/device/device_energy.h"
#include "garment/energy/membrane_kernels.h"
#include "garment/energy/rest_shape.h"

namespace toile {

/// Membrane of all cloths of a body on a GPU: a kernel over triangles, and one that gathers at vertices.
class DeviceMembrane : public DeviceEnergy {
public:
    explicit DeviceMembrane(const CudaSpace& space);

    /// Adds a cloth after those before it.
    /// @param first_vertex  of the cloth among the body's
    void add(const RestShape& rest, const MembraneWeights& weights, int first_vertex);

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
    };
    void upload();

    const CudaSpace& space_;
    OnHost host_;
    DeviceArray<Triangle> triangles_;
    DeviceArray<Mat2> rest_inv_;
    DeviceArray<double> area_;
    DeviceArray<int> fabric_;
    DeviceArray<MembraneWeights> weights_;
    DeviceArray<int> first_corner_, corners_;
    DeviceArray<CornerPair> corner_gradient_; ///< [triangles] [N]
    DeviceArray<double> energy_;              ///< [triangles] [J]
};

} // namespace toile
