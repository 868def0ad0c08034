#pragma once

#include "core/backend/lanes.h"

namespace toile {

/// What an ActiveSetEnergy has on a GPU between begin_step() and revise(): its terms as the host found them.
/// Functions enqueue unless they say otherwise; all fields are the device's.
class DeviceActiveSet {
public:
    /// The Hessian as frozen last, by the vertices that it touches ("lists").
    struct Frozen {
        View<const int> list_of;  ///< [vertices] number of its list and 1; 0: none
        View<const int> vertices; ///< [lists]
        View<const int> acting;   ///< [lists] how many terms of each act
        View<const Mat3> blocks;  ///< [lists] bounds as FrozenHessian::diagonal_blocks() [N/m]
        View<const Vec3> product; ///< [lists] of the last multiply() [N]
    };

    virtual ~DeviceActiveSet() = default;

    /// False where the host has found nothing that could act.
    virtual bool has_terms() const = 0;

    /// Adds the gradient [N] and shares of the energy [J] at x [vertices] [m], and freezes the terms active
    /// there.
    virtual void evaluate(View<const Vec3> x, View<Vec3> gradient, View<double> energy) = 0;

    /// Product of the frozen Hessian with p [vertices] [m].
    virtual void multiply(View<const PaddedVec3> p) = 0;

    virtual Frozen frozen() const = 0;
};

} // namespace toile
