#include "core/pd/energy/step_field.h"

#include "core/compute/cuda/mirrored_array.h"

namespace toile {

int StepField::size() const { return mirrored_ ? mirrored_->size() : of_host_.size(); }

View<const Vec3> StepField::host() const
{
    return mirrored_ ? mirrored_->host() : View<const Vec3>(of_host_);
}

View<Vec3> StepField::change_on_host() const { return mirrored_ ? mirrored_->change_on_host() : of_host_; }

View<const Vec3> StepField::device() const
{
    TOILE_ASSERT(mirrored_ != nullptr);
    return mirrored_->device();
}

View<Vec3> StepField::change_on_device() const
{
    TOILE_ASSERT(mirrored_ != nullptr);
    return mirrored_->change_on_device();
}

} // namespace toile
