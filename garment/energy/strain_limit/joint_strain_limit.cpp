#include "garment/energy/strain_limit/joint_strain_limit.h"

#include <algorithm>

#include "core/base/stages.h"
#include "garment/energy/strain_limit/cuda/strain_limit.h"

namespace toile::garment {

JointStrainLimit::JointStrainLimit(std::vector<Part> parts) : parts_(std::move(parts)) {}
JointStrainLimit::~JointStrainLimit() = default;

double JointStrainLimit::max_strain_on_device() const
{
    TOILE_ASSERT(device_limit_ != nullptr);
    return device_limit_->max_strain();
}

void JointStrainLimit::observe(View<const Vec3> x)
{
    for (const Part& part : parts_)
        part.limit->observe(x.subview(part.first, part.count));
}

void JointStrainLimit::project(View<Vec3> x, View<const double> inverse_masses,
                               const std::function<bool()>& clear_contacts)
{
    bool violates = false;
    for (const Part& part : parts_)
        violates = part.limit->find_violations(x.subview(part.first, part.count)) || violates;
    if (!violates)
        return;
    for (const Part& part : parts_)
        part.limit->keep(x.subview(part.first, part.count));
    const auto has_sweep = [](const Part& part, int sweep) {
        return part.limit->violates() && sweep < part.limit->max_sweeps();
    };
    const auto any_has = [&](int sweep) {
        return std::any_of(parts_.begin(), parts_.end(),
                           [&](const Part& part) { return has_sweep(part, sweep); });
    };
    for (int sweep = 0; any_has(sweep); ++sweep) {
        const StageScope stage("garment/strain_limit");
        for (const Part& part : parts_)
            if (has_sweep(part, sweep))
                part.limit->sweep(sweep, x.subview(part.first, part.count),
                                  inverse_masses.subview(part.first, part.count));
        const bool cleared = clear_contacts && sweep < StrainLimit::kSweepsWithContact && clear_contacts();
        for (const Part& part : parts_)
            if (cleared || has_sweep(part, sweep))
                part.limit->update_violations(x.subview(part.first, part.count), cleared);
    }
    for (const Part& part : parts_)
        part.limit->end(x.subview(part.first, part.count));
}

DeviceStepProjection* JointStrainLimit::on_device(const CudaSpace& space)
{
    if (!device_limit_) {
        device_limit_ = std::make_unique<DeviceStrainLimit>(space);
        for (const Part& part : parts_)
            device_limit_->add(*part.limit, part.first);
    }
    return device_limit_.get();
}

double JointStrainLimit::max_strain(View<const Vec3> x) const
{
    double largest = 0.0;
    for (const Part& part : parts_)
        largest = std::max(largest, part.limit->max_strain(x.subview(part.first, part.count)));
    return largest;
}

} // namespace toile::garment
