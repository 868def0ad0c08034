#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/energy.h"
#include "garment/energy/springs.h"

namespace toile::garment {

/// Springs of all cloths of a body on a GPU. Targets and releases are read from the host before every step.
class DeviceSprings : public DeviceEnergy {
public:
    explicit DeviceSprings(const CudaSpace& space);

    /// Adds the springs of a cloth; all are added before the first step.
    /// @param springs       borrowed
    /// @param first_vertex  first vertex of the cloth in the body
    void add(const Springs& springs, int first_vertex);

    void begin_step(View<const Vec3> x, double dt) override;
    void add_gradient(const DeviceEvaluation& at) override;
    void add_curvature(const DeviceCurvature& at) override;

private:
    struct Part {
        const Springs* springs;
        int first_vertex;
    };

    void take_springs();

    const CudaSpace& space_;
    std::vector<Part> parts_;
    std::vector<AnchorSpring> host_; ///< ascending by vertex
    std::vector<int> order_;         ///< indices into host_ of the springs, cloth by cloth
    DeviceArray<AnchorSpring> anchors_;
    DeviceArray<int> first_; ///< [attached vertices + 1] into anchors_
};

} // namespace toile::garment
