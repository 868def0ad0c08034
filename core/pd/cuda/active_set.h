#pragma once

#include "core/compute/lanes.h"

namespace toile {

/// Terms of an ActiveSetEnergy on a GPU between begin_step() and revise(), as the host found them. Functions
/// enqueue unless they say otherwise; all fields are on the device.
class DeviceActiveSet {
public:
    /// Frozen Hessian by vertex: one "list" of terms per vertex with frozen terms.
    struct Frozen {
        View<const int> list_of;      ///< [vertices] number of the vertex's list plus 1; 0: none
        View<const int> vertices;     ///< [lists]
        View<const int> active_count; ///< [lists] active terms of each
        View<const Mat3> blocks;      ///< [lists] bounds, as FrozenHessian::diagonal_blocks() [N/m]
        View<const Vec3> product;     ///< [lists] result of the last multiply() [N]
    };

    virtual ~DeviceActiveSet() = default;

    /// False if the host has found no candidate terms.
    virtual bool has_terms() const = 0;

    /// Adds the gradient [N] and parts of the energy [J] at x [vertices] [m], and freezes the terms active
    /// there.
    virtual void evaluate(View<const Vec3> x, View<Vec3> gradient, View<double> energy) = 0;

    /// Multiplies the frozen Hessian by p [vertices] [m].
    virtual void multiply(View<const PaddedVec3> p) = 0;

    virtual Frozen frozen() const = 0;
};

} // namespace toile
