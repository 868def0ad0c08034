#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/linear/sliced_rows.h"
#include "core/pd/cuda/energy.h"
#include "core/pd/cuda/newton/element_blocks.h"
#include "garment/energy/rest_shape.h"
#include "garment/energy/viscosity_kernels.h"

namespace toile::garment {

/// Membrane and bending of all cloths of a body on a GPU. One kernel runs over triangles. A second one
/// gathers at vertices and multiplies positions by the bending matrix.
///
/// The membrane's second derivative is projected. That of bending is constant, so it is in the Hessian's
/// pattern already.
class DeviceElasticity : public DeviceEnergy {
public:
    explicit DeviceElasticity(const CudaSpace& space);

    /// Adds the membrane of a cloth after the previous ones.
    /// @param viscosity     weights of a step of one second; if they are zero for all cloths, nothing is
    ///                      evaluated for them
    /// @param first_vertex  first vertex of the cloth in the body
    void add_membrane(const RestShape& rest, const MembraneWeights& weights, const ViscousWeights& viscosity,
                      int first_vertex);

    /// Adds the bending of a cloth after the previous ones. Its membrane is added before or later.
    /// @param K  Bending::matrix()
    void add_bending(const SparseMatrix& K, int first_vertex);

    void begin_step(View<const Vec3> x, double dt) override;
    int partial_count() const override { return triangles_.size(); }
    void add_gradient(const DeviceEvaluation& at) override;
    void find_entries(const HessianPattern& pattern) override;
    void add_curvature(const DeviceCurvature& at) override;

private:
    /// Data of the device arrays, for all cloths so far.
    struct OnHost {
        std::vector<Triangle> triangles;
        std::vector<Mat2> rest_inv;
        std::vector<double> area;
        std::vector<int> fabric;
        std::vector<MembraneWeights> weights;
        std::vector<int> viscous_fabric;
        std::vector<ViscousWeights> viscosity{{}}; ///< by viscous_fabric, of a step of one second
        std::vector<int> first_corner{0}, corners;
        std::vector<int> bending_first{0}, bending_column; ///< rows of K
        std::vector<float> bending_value;
    };
    void upload(); ///< the membrane
    bool is_viscous() const { return host_.viscosity.size() > 1; }
    ViscousTriangles viscosity() const;
    template <typename Viscosity>
    void project(const DeviceEvaluation& at, const Viscosity& viscosity);
    template <typename Viscosity>
    void curve(View<const Vec3> x, const Viscosity& viscosity);

    const CudaSpace& space_;
    OnHost host_;
    DeviceArray<Triangle> triangles_;
    DeviceArray<Mat2> rest_inv_;
    DeviceArray<double> area_;
    DeviceArray<int> fabric_;
    DeviceArray<MembraneWeights> weights_;
    DeviceArray<int> viscous_fabric_;             ///< this and the next two are empty without viscosity
    DeviceArray<ViscousWeights> viscous_weights_; ///< of this step; zero before the first
    DeviceArray<GreenStrain<double>> start_;      ///< [triangles] at the start of this step
    DeviceElementBlocks side_blocks_;
    DeviceArray<int> first_corner_, corners_;
    DeviceArray<CornerPair> corner_gradient_; ///< [triangles] [N]
    DeviceArray<int> bending_first_;          ///< SlicedRows of K
    DeviceArray<RowEntry> bending_entries_;
};

} // namespace toile::garment
