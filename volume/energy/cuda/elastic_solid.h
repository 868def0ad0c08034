#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/energy.h"
#include "core/pd/cuda/newton/element_blocks.h"
#include "volume/energy/cuda/elastic_tets.h"
#include "volume/energy/rest_tets.h"

namespace toile::volume {

/// ElasticSolid of all solids of a body on a GPU: one kernel over tetrahedra, and one that gathers at
/// vertices in the order of the CPU. The second derivative is projected.
class DeviceElasticSolid : public DeviceEnergy {
public:
    explicit DeviceElasticSolid(const CudaSpace& space);

    /// Adds a solid after the previous ones; all are added before the first step.
    /// @param lame          [tets]
    /// @param first_vertex  first vertex of the solid in the body
    void add(const RestTets& rest, View<const Lame> lame, int first_vertex);

    int partial_count() const override { return tets_.size(); }
    void add_gradient(const DeviceEvaluation& at) override;
    void find_entries(const HessianPattern& pattern) override;
    void add_curvature(const DeviceCurvature& at) override;

private:
    /// Data of the device arrays, for all solids so far.
    struct OnHost {
        std::vector<Tet> tets;
        std::vector<Mat3> rest_inv;
        std::vector<double> volume;
        std::vector<Lame> lame;
        std::vector<int> first_corner{0}, corners;
    };
    ElasticTets solid() const { return {tets_.view(), rest_inv_.view(), volume_.view(), lame_.view()}; }

    const CudaSpace& space_;
    OnHost host_;
    DeviceArray<Tet> tets_;
    DeviceArray<Mat3> rest_inv_;
    DeviceArray<double> volume_;
    DeviceArray<Lame> lame_;
    DeviceArray<int> first_corner_, corners_;
    DeviceArray<Mat3> corner_gradient_; ///< [tets] [N]
    DeviceElementBlocks blocks_;
};

} // namespace toile::volume
