#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/compute/cuda/scan.h"
#include "core/pd/cuda/energy.h"
#include "core/pd/cuda/newton/element_blocks.h"
#include "garment/energy/strain_limit/stretch_tension.h"

namespace toile::garment {

/// StretchTension of all cloths of a body on a GPU, which owns their tension between steps.
///
/// An evaluation is one kernel over the vertices of triangles near their limit. It evaluates each triangle
/// once per corner. The list of vertices is made at the start of a step; the launches do not depend on its
/// length. The second derivative costs a kernel over triangles and one over edges that does little at most of
/// them.
class DeviceStretchTension : public DeviceEnergy {
public:
    explicit DeviceStretchTension(const CudaSpace& space);

    /// Adds a cloth after the previous ones; all are added before the first step. It has no tension yet.
    /// @param tension       borrowed: its forgotten() is read before each step
    /// @param first_vertex  first vertex of the cloth in the body
    void add(const StretchTension& tension, int first_vertex);

    void begin_step(View<const Vec3> x, double dt) override;
    void add_gradient(const DeviceEvaluation& at) override;
    void find_entries(const HessianPattern& pattern) override;
    void add_curvature(const DeviceCurvature& at) override;
    void end_minimisation(View<const Vec3> x) override;

private:
    struct Part {
        const StretchTension* tension;
        int first, count; ///< triangles
        int forgotten;    ///< forget() calls handled so far
    };
    /// Data of the device arrays, for all cloths so far.
    struct OnHost {
        std::vector<Triangle> triangles;
        std::vector<Mat2> rest_inv;
        std::vector<double> area;
        std::vector<int> kind;
        std::vector<TensionLimits> limits;
        std::vector<int> first_corner{0}, corners;
    };
    void append(const StretchTension& tension, int first_vertex);
    void upload();
    TensionPull pull(View<const Vec3> x) const;

    const CudaSpace& space_;
    std::vector<Part> parts_;
    OnHost host_;
    DeviceArray<Triangle> triangles_;
    DeviceArray<Mat2> rest_inv_;
    DeviceArray<double> area_;
    DeviceArray<int> kind_;
    DeviceArray<TensionLimits> limits_;
    DeviceArray<int> first_corner_, corners_;
    DeviceArray<Mat2> tension_;                  ///< [triangles] T_t / k in material axes
    DeviceArray<Mat32> rotated_tension_;         ///< [triangles] T_t / k at this step, if near
    DeviceArray<unsigned char> near_, has_near_; ///< [triangles]; [vertices] with one that is near
    DeviceArray<int> watched_, watched_count_;   ///< vertices with a triangle that is near, [1] their number
    DeviceScratch scratch_;
    DeviceArray<unsigned char> exceeds_; ///< [triangles] at the last add_curvature()
    DeviceElementBlocks side_blocks_;
};

} // namespace toile::garment
