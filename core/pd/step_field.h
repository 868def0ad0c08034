#pragma once

#include <vector>

#include "core/backend/cuda/mirrored_array.h"

namespace toile {

/// Borrowed positions or velocities of a step in the making: of the host or, where a GPU makes the step, of
/// both sides. A side is copied when somebody asks for it and only where the other has changed it since; a
/// view is good until the other side changes the field.
class StepField {
public:
    // Conversions, for whoever has a field to pass it.
    StepField(View<Vec3> of_host) : of_host_(of_host) {}
    StepField(std::vector<Vec3>& of_host) : of_host_(of_host) {}
    StepField(MirroredArray<Vec3>& mirrored) : mirrored_(&mirrored) {}

    int size() const { return mirrored_ ? mirrored_->size() : of_host_.size(); }

    View<const Vec3> host() const { return mirrored_ ? mirrored_->host() : View<const Vec3>(of_host_); }
    View<Vec3> change_on_host() const { return mirrored_ ? mirrored_->change_on_host() : of_host_; }

    /// Only of fields that a GPU works on.
    View<const Vec3> there() const
    {
        TOILE_ASSERT(mirrored_ != nullptr);
        return mirrored_->there();
    }
    View<Vec3> change_there() const
    {
        TOILE_ASSERT(mirrored_ != nullptr);
        return mirrored_->change_there();
    }

private:
    View<Vec3> of_host_;
    MirroredArray<Vec3>* mirrored_ = nullptr; ///< null: of the host only
};

} // namespace toile
