#pragma once

#include <vector>

#include "core/backend/cuda/array.h"
#include "core/backend/cuda/scan.h"
#include "core/pd/device/device_energy.h"
#include "garment/energy/stretch_tension.h"

namespace toile {

/// StretchTension of all cloths of a body on a GPU, which owns their tension from one step to the next.
///
/// An evaluation is one kernel over the vertices of triangles near their limit, which works each triangle out
/// once per corner. They are listed where a step starts; what is launched does not depend on how many there
/// are.
class DeviceStretchTension : public DeviceEnergy {
public:
    explicit DeviceStretchTension(const CudaSpace& space);

    /// Adds a cloth after those before it: all of them before the first step. It carries no tension yet.
    /// @param tension       borrowed: before each step it is asked whether it was told to forget
    /// @param first_vertex  of the cloth among the body's
    void add(const StretchTension& tension, int first_vertex);

    void begin_step(View<const Vec3> x) override;
    void add_gradient(const DeviceEvaluation& at) override;
    void end_minimisation(View<const Vec3> x) override;

private:
    struct Part {
        const StretchTension* tension;
        int first, count; ///< triangles
        int forgotten;    ///< times that it has forgotten so far
    };
    /// What is on the device, of all cloths so far.
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
    DeviceArray<Mat32> turned_;                  ///< [triangles] T_t / k at this step, where near
    DeviceArray<unsigned char> near_, has_near_; ///< [triangles]; [vertices] with one that is near
    DeviceArray<int> watched_, watched_count_;   ///< vertices that have one, [1] how many
    DeviceScratch scratch_;
};

} // namespace toile
