#pragma once

#include <memory>
#include <vector>

#include "garment/energy/strain_limit/strain_limit.h"

namespace toile::garment {

class DeviceStrainLimit;

/// Strain limits of several cloths in one body, each on its own range of vertices. They are swept together,
/// because contact clearing between two sweeps also moves cloth that was within its limit.
class JointStrainLimit : public StepProjection {
public:
    struct Part {
        StrainLimit* limit; ///< borrowed
        int first, count;   ///< vertices of the body, ascending
    };

    explicit JointStrainLimit(std::vector<Part> parts);
    ~JointStrainLimit() override;

    void observe(View<const Vec3> x) override;
    void project(View<Vec3> x, View<const double> inverse_masses,
                 const std::function<bool()>& clear_contacts) override;
    DeviceStepProjection* on_device(const CudaSpace& space) override;

    /// Maximum of StrainLimit::max_strain() over all cloths [-].
    double max_strain(View<const Vec3> x) const;

    /// max_strain() at the end of the last step made on a GPU.
    double max_strain_on_device() const;

private:
    std::vector<Part> parts_;
    std::unique_ptr<DeviceStrainLimit> device_limit_; ///< null before the first call of on_device()
};

} // namespace toile::garment
