#include "garment/energy/joint_strain_limit.h"

#include <algorithm>

namespace toile {

void JointStrainLimit::observe(View<const Vec3> x)
{
    for (const Part& part : parts_)
        part.limit->observe(x.subview(part.first, part.count));
}

void JointStrainLimit::project(View<Vec3> x, View<const double> inverse_masses,
                               const std::function<bool()>& clear_contacts)
{
    for (const Part& part : parts_)
        part.limit->project(x.subview(part.first, part.count), inverse_masses.subview(part.first, part.count),
                            clear_contacts);
}

DeviceStepProjection* JointStrainLimit::on_device(const CudaSpace& space)
{
    if (!there_) {
        there_ = std::make_unique<DeviceStrainLimit>(space);
        for (const Part& part : parts_)
            there_->add(*part.limit, part.first);
    }
    return there_.get();
}

double JointStrainLimit::max_strain(View<const Vec3> x) const
{
    double largest = 0.0;
    for (const Part& part : parts_)
        largest = std::max(largest, part.limit->max_strain(x.subview(part.first, part.count)));
    return largest;
}

} // namespace toile
