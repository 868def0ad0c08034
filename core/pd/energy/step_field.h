#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile {

template <typename T>
class MirroredArray;

/// Borrowed positions or velocities during a step: on the host or, if a GPU makes the step, on both sides. A
/// side is copied at access and only if the other has changed it since. A view is valid until the other side
/// changes the field.
class StepField {
public:
    // Conversions, so that callers can pass their fields.
    StepField(View<Vec3> of_host) : of_host_(of_host), size_(of_host.size()) {}
    StepField(std::vector<Vec3>& of_host) : StepField(View<Vec3>(of_host)) {}
    StepField(MirroredArray<Vec3>& mirrored);

    int size() const { return size_; }

    /// The first `count` of it.
    StepField leading(int count) const;

    View<const Vec3> host() const;
    View<Vec3> change_on_host() const;

    // For fields with a device side only.
    View<const Vec3> device() const;
    View<Vec3> change_on_device() const;

private:
    View<Vec3> of_host_;
    MirroredArray<Vec3>* mirrored_ = nullptr; ///< null: host only
    int size_ = 0;                            ///< may be less than that of the array
};

} // namespace toile
