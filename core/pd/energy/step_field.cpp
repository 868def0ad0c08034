#include "core/pd/energy/step_field.h"

#include "core/compute/cuda/mirrored_array.h"

namespace toile {

StepField::StepField(MirroredArray<Vec3>& mirrored) : mirrored_(&mirrored), size_(mirrored.size()) {}

StepField StepField::leading(int count) const
{
    TOILE_ASSERT(count <= size_);
    StepField first = *this;
    first.size_ = count;
    return first;
}

View<const Vec3> StepField::host() const
{
    return mirrored_ ? mirrored_->host().subview(0, size_) : of_host_.subview(0, size_);
}

View<Vec3> StepField::change_on_host() const
{
    return mirrored_ ? mirrored_->change_on_host().subview(0, size_) : of_host_.subview(0, size_);
}

View<const Vec3> StepField::device() const
{
    TOILE_ASSERT(mirrored_ != nullptr);
    return mirrored_->device().subview(0, size_);
}

View<Vec3> StepField::change_on_device() const
{
    TOILE_ASSERT(mirrored_ != nullptr);
    return mirrored_->change_on_device().subview(0, size_);
}

} // namespace toile
