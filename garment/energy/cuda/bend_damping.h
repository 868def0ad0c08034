#pragma once

#include <array>
#include <vector>

#include "core/compute/cuda/array.h"
#include "core/linear/sliced_rows.h"
#include "core/mesh/topology.h"
#include "core/pd/cuda/energy.h"
#include "garment/energy/bend_damping_kernels.h"

namespace toile::garment {

/// BendDamping of all cloths of a body on a GPU. A kernel over hinges stores their forces or stiffnesses;
/// others gather them at vertices and at the entries of the Hessian.
class DeviceBendDamping : public DeviceEnergy {
public:
    explicit DeviceBendDamping(const CudaSpace& space);

    /// Adds a cloth after the previous ones.
    /// @param slots         4 * hinge + slot, by vertex of the cloth
    /// @param first_vertex  first vertex of the cloth in the body
    void add(const std::vector<Hinge>& hinges, const Incidence& slots, int first_vertex);

    void begin_step(View<const Vec3> x, double dt) override;
    int partial_count() const override { return hinges_.size(); }
    void add_gradient(const DeviceEvaluation& at) override;
    void find_entries(const HessianPattern& pattern) override;
    void add_curvature(const DeviceCurvature& at) override;

private:
    HingesInStep in_step(View<const Vec3> x) const;

    const CudaSpace& space_;
    std::vector<Hinge> host_hinges_; ///< of all cloths so far; likewise the next two
    std::vector<int> host_first_{0}, host_slots_;
    DeviceArray<Hinge> hinges_;
    DeviceArray<int> first_, slots_;
    DeviceArray<double> dt_;             ///< [1] [s] of this step, 0 before the first
    DeviceArray<HingeStart> start_;      ///< [hinges]
    DeviceArray<PaddedVec3> force_;      ///< [4 * hinges] [N]
    DeviceArray<float> stiffness_;       ///< [hinges] [N m]
    DeviceArray<int> pair_first_;        ///< [pairs + 1] into pair_weights_
    DeviceArray<RowEntry> pair_weights_; ///< hinges of a pair of vertices, and the product of their weights
    DeviceArray<std::array<int, 2>> positions_; ///< [pairs] of the two entries
};

} // namespace toile::garment
