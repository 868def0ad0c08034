#pragma once

#include <memory>
#include <vector>

#include "garment/energy/device_strain_limit.h"
#include "garment/energy/strain_limit.h"

namespace toile {

/// Strain limits of several cloths in one body, each on its own range of vertices. They are swept together,
/// for contact that is cleared between two sweeps moves cloth that was within its limit before.
class JointStrainLimit : public StepProjection {
public:
    struct Part {
        StrainLimit* limit; ///< borrowed
        int first, count;   ///< vertices of the body, ascending
    };

    explicit JointStrainLimit(std::vector<Part> parts) : parts_(std::move(parts)) {}

    void observe(View<const Vec3> x) override;
    void project(View<Vec3> x, View<const double> inverse_masses,
                 const std::function<bool()>& clear_contacts) override;
    DeviceStepProjection* on_device(const CudaSpace& space) override;

    /// As StrainLimit's, the largest of all.
    double max_strain(View<const Vec3> x) const;

    /// The same at the end of the last step that a GPU has made.
    double max_strain_there() const
    {
        TOILE_ASSERT(there_ != nullptr);
        return there_->max_strain();
    }

private:
    std::vector<Part> parts_;
    std::unique_ptr<DeviceStrainLimit> there_; ///< null before a GPU asks
};

} // namespace toile
